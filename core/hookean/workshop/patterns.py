"""Cutting patterns: a surface cut along seams into strips, each flattened, compensated, with allowances and marks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.flatten import Flat, directed, flatten, oriented, outline, turned_along
from hookean.discretize.geodesics import cut_along
from hookean.discretize.mesh_strips import row_edges, strips
from hookean.discretize.meshes import as_mesh
from hookean.discretize.outlines import offset
from hookean.errors import InputError
from hookean.running.result import Result
from hookean.running.run import relax
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LARGEST = 0.5  # compensation


@dataclass(frozen=True)
class Mark:
    """A point (2,) on a seam that meets the mark of the same `name` on the other strip, and the way out (2,)."""

    name: str
    point: Floats
    way: Floats


@dataclass(frozen=True)
class Strip:
    """A strip in the plane, its warp along x, compensated.

    `vertices` (k,) are its vertices in the mesh and `points` (k, 2) [length] where they lie; `faces` (m, 4) index
    these; `seam` (l,) are the vertices of its outline, counter-clockwise, as numbers of `points`, and `beside` (l,) the
    strip on the other side of each of its sides, -1 on the edge of the surface. `cut` (c, 2) is the outline with
    allowances. `flat` has the distortions of flattening, before compensation.
    """

    number: int
    vertices: Ints
    faces: Ints
    points: Floats
    seam: Ints
    beside: Ints
    cut: Floats
    marks: tuple[Mark, ...]
    flat: Flat = field(repr=False)

    @property
    def name(self) -> str:
        """How it is labelled: S1, S2 ..."""
        return f"S{self.number + 1}"

    @property
    def size(self) -> tuple[float, float]:
        """Length and width of the cloth that it is cut from [length]."""
        x, y = np.ptp(self.cut, axis=0)
        return float(x), float(y)

    @property
    def area(self) -> float:
        """Area within the seams [length^2]."""
        x, y = self.points[self.seam].T
        return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "name": self.name,
            "vertices": self.vertices.tolist(),
            "points": self.points.tolist(),
            "faces": self.faces.tolist(),
            "seam": self.seam.tolist(),
            "beside": self.beside.tolist(),
            "cut": self.cut.tolist(),
            "marks": [{"name": mark.name, "point": mark.point.tolist()} for mark in self.marks],
        }


@dataclass(frozen=True)
class Patterns:
    """The strips of a surface, and what sewing them meets: by pairs of strips the lengths of their common seam on
    either side [length]."""

    strips: tuple[Strip, ...]
    mesh: Mesh = field(repr=False)
    compensation: tuple[float, float]
    seams: dict[tuple[int, int], tuple[float, float]]
    units: Units = field(default_factory=Units)

    def table(self) -> list[dict[str, Any]]:
        """The report of distortions: a row for each strip."""
        unit = self.units.length
        rows = []
        for strip in self.strips:
            mismatch = [abs(a - b) for pair, (a, b) in self.seams.items() if strip.number in pair]
            rows.append(
                {
                    "strip": strip.name,
                    f"length [{unit}]": strip.size[0],
                    f"width [{unit}]": strip.size[1],
                    f"area [{unit}²]": strip.area,
                    "largest distortion [-]": strip.flat.distortion,
                    "mean distortion [-]": strip.flat.mean_distortion,
                    "largest stretch [-]": float(strip.flat.stretches.max()),
                    "smallest stretch [-]": float(strip.flat.stretches.min()),
                    f"seam mismatch [{unit}]": max(mismatch, default=0.0),
                }
            )
        return rows

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "strips": [strip.to_dict() for strip in self.strips],
            "seams": [{"strips": list(pair), "lengths": list(sides)} for pair, sides in self.seams.items()],
            "compensation": list(self.compensation),
            "table": self.table(),
            "units": self.units.model_dump(),
        }

    def summary(self) -> list[str]:
        """A few lines for a person."""
        unit = self.units.length
        worst = max(self.strips, key=lambda strip: strip.flat.distortion)
        off = max((abs(a - b) for a, b in self.seams.values()), default=0.0)
        cloth = sum(strip.size[0] * strip.size[1] for strip in self.strips)
        return [
            f"{len(self.strips)} strips, {cloth:.4g} {unit}² of cloth",
            f"largest distortion {100.0 * worst.flat.distortion:.4g} % in {worst.name}",
            f"sides of a seam differ by up to {off:.4g} {unit}",
        ]


def cutting_patterns(
    surface: Any,
    *,
    mesh: str | None = None,
    along: Literal["warp", "weft"] = "warp",
    rows: int = 1,
    labels: Sequence[int] | Ints | None = None,
    seams: Sequence[tuple[int, int]] | None = None,
    compensation: tuple[float, float] = (0.0, 0.0),
    allowance: float = 0.0,
    edge_allowance: float | None = None,
    mark_every: int = 1,
) -> Patterns:
    """Cut a surface into strips and lay them flat with the least distortion.

    - `surface`: A mesh; a result, or a scene, which is relaxed, with `mesh`, the name of one of the scene's meshes
      (default: the only one).
    - `along`: The direction of the strips by the rows of a quad mesh; the warp of the cloth lies along these rows, and
      without them (`labels`, `seams`) along the longer way of the strip.
    - `rows`: Rows of faces to a strip.
    - `labels`: The strip of each face instead, numbered from 0; each strip must be a disc.
    - `seams`: Pairs of vertices of the mesh instead: the surface is cut along the geodesics between them, which lie
      nearly straight in flat cloth. Its faces are triangles then, and `Patterns.mesh` has the vertices of the cuts.
    - `compensation`: Strains of the cloth under prestress along warp and weft [-]; the strips are smaller by these, so
      that sewn and stretched they have the size of the form.
    - `allowance`: Width of cloth beyond seams [length]; `edge_allowance` beyond edges; default: the same.
    - `mark_every`: A mark at each so many vertices of a seam; 0: none.

    Raises InputError where strips cannot be laid flat, or values make no sense.
    Source: Gruendig, Moncrieff, Singer and Stroebel, A history of the principal developments and applications of the
    force density method in Germany, 2000 (compensation and flattening of strips).
    """
    shape, units = _surface(surface, mesh)
    _checked(compensation, allowance, edge_allowance, mark_every)
    if seams is not None:
        if labels is not None:
            raise InputError("seams", "labels are given, too; give one of them")
        shape, labels = cut_along(shape, seams)
    threads = None if labels is not None else row_edges(shape, along)
    number = np.asarray(strips(shape, along, rows) if labels is None else labels, dtype=np.int64)
    if number.shape != (len(shape.faces),):
        raise InputError("labels", f"{len(number)} labels for {len(shape.faces)} faces; give one for each")
    _, number = np.unique(number, return_inverse=True)
    owners = _owners(shape.faces, number)
    wide = allowance, allowance if edge_allowance is None else edge_allowance
    found = tuple(
        _strip(shape, number, i, owners, threads, compensation, wide, mark_every) for i in range(int(number.max()) + 1)
    )
    return Patterns(found, shape, (float(compensation[0]), float(compensation[1])), _seams(found), units)


def strains(
    prestress: tuple[float, float], stiffness: tuple[float, float], poisson: float = 0.0
) -> tuple[float, float]:
    """The strains [-] of cloth along warp and weft under a prestress [force/length] there, as `membrane` has them: e1 =
    (n1 - nu n2) / k1, e2 = n2 / k2 - nu n1 / k1 with stiffnesses k [force/length]. Poisson's ratio nu is how much the
    cloth contracts along the weft where the warp is pulled."""
    (n1, n2), (k1, k2) = prestress, stiffness
    return (n1 - poisson * n2) / k1, n2 / k2 - poisson * n1 / k1


def _surface(surface: Any, name: str | None) -> tuple[Mesh, Units]:
    if isinstance(surface, Scene):
        surface = relax(surface)
        if not surface.converged:
            raise InputError("model", f"no form was found: {surface.message}")
    if not isinstance(surface, Result):
        return as_mesh(surface), Units()
    if surface.scene is None or not surface.scene.meshes:
        raise InputError("result", "has no mesh; give one, or a result of a scene with meshes")
    known = surface.scene.meshes
    if name is None and len(known) > 1:
        raise InputError("mesh", f"the scene has {', '.join(known)}; name one of them")
    chosen = name if name is not None else next(iter(known))
    if chosen not in known:
        raise InputError("mesh", f"{chosen!r} is not a mesh of the scene; it has {', '.join(known)}")
    from hookean.system.weld import Welded

    at = Welded(surface.scene).vertices(chosen)
    if (at < 0).any():
        raise InputError("mesh", f"vertex {int(np.argmax(at < 0))} of {chosen!r} is no particle of the result")
    return Mesh(surface.particles[at], np.asarray(known[chosen].faces)), surface.units


def _checked(compensation: Any, allowance: float, edge_allowance: float | None, mark_every: int) -> None:
    given = np.asarray(compensation, dtype=float)
    if given.shape != (2,) or not (np.isfinite(given) & (np.abs(given) < LARGEST)).all():
        raise InputError("compensation", f"{compensation!r} given; two strains between -{LARGEST:g} and {LARGEST:g}")
    for place, width in (("allowance", allowance), ("edge_allowance", edge_allowance)):
        if width is not None and not (np.isfinite(width) and width >= 0.0):
            raise InputError(place, f"{width!r} given; a width of at least 0 is expected")
    if not (isinstance(mark_every, int) and mark_every >= 0):
        raise InputError("mark_every", f"{mark_every!r} given; a whole number from 0 is expected")


def _owners(faces: Ints, number: Ints) -> dict[tuple[int, int], list[int]]:
    """By each side of faces, as a sorted pair of vertices, the strips it belongs to."""
    found: dict[tuple[int, int], list[int]] = {}
    for face, strip in zip(faces.tolist(), number.tolist(), strict=True):
        corners = face[:3] if face[2] == face[3] else face
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
            found.setdefault((min(a, b), max(a, b)), []).append(strip)
    return found


def _strip(
    shape: Mesh,
    number: Ints,
    index: int,
    owners: dict[tuple[int, int], list[int]],
    threads: Ints | None,
    compensation: tuple[float, float],
    allowances: tuple[float, float],
    mark_every: int,
) -> Strip:
    mine = shape.faces[number == index]
    vertices, local = np.unique(mine, return_inverse=True)
    faces = oriented(local.reshape(mine.shape))
    try:
        flat = flatten(Mesh(shape.vertices[vertices], faces))
    except InputError as error:
        raise InputError(f"strip {index + 1}", error.sentence) from None
    seam = outline(faces)
    points = turned_along(flat.points, _grain(flat.points, vertices, faces, threads))
    points = points / (1.0 + np.asarray(compensation, dtype=float))
    sides = zip(vertices[seam].tolist(), np.roll(vertices[seam], -1).tolist(), strict=True)
    both = [owners[min(a, b), max(a, b)] for a, b in sides]
    beside = np.array([next((s for s in pair if s != index), -1 if len(pair) < 2 else index) for pair in both])
    distances = np.where(beside >= 0, allowances[0], allowances[1])
    cut = offset(points[seam], distances) if max(allowances) > 0.0 else points[seam]
    marks = _marks(index, vertices, points, seam, beside, mark_every)
    return Strip(index, vertices, faces, points, seam, beside, cut, marks, flat)


def _grain(points: Floats, vertices: Ints, faces: Ints, threads: Ints | None) -> Floats:
    """The direction (2,) of the warp of a flat strip, to the right: the mean one of the edges (k, 2) of its rows, or
    without rows that in which its points lie furthest apart."""
    if threads is None:
        ways = points - points.mean(axis=0)
    else:
        place = np.minimum(np.searchsorted(vertices, threads), len(vertices) - 1)
        known = place[(vertices[place] == threads).all(axis=1)]
        sides = np.sort(directed(faces), axis=1) @ [len(vertices), 1]
        own = known[np.isin(np.sort(known, axis=1) @ [len(vertices), 1], sides)]
        ways = points[own[:, 1]] - points[own[:, 0]]
    values, axes = np.linalg.eigh(ways.T @ ways)
    way = axes[:, int(np.argmax(values))]
    return np.asarray(-way if way[int(np.argmax(np.abs(way)))] < 0.0 else way)


def _marks(index: int, vertices: Ints, points: Floats, seam: Ints, beside: Ints, every: int) -> tuple[Mark, ...]:
    """Marks on the seams with other strips: their names are those of the strips and of the vertex."""
    found: list[Mark] = []
    along = points[np.roll(seam, -1)] - points[seam]
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    out = out / np.linalg.norm(out, axis=1)[:, None]
    for i, corner in enumerate(seam.tolist()):
        near = {int(beside[i - 1]), int(beside[i])} - {-1}
        for other in sorted(near):
            if every and int(vertices[corner]) % every == 0:
                way = out[i] if beside[i] == other else out[i - 1]
                low, high = sorted((index, other))
                found.append(Mark(f"{low + 1}-{high + 1}/{int(vertices[corner])}", points[corner], way))
    return tuple(found)


def _seams(strips: tuple[Strip, ...]) -> dict[tuple[int, int], tuple[float, float]]:
    """By pairs of strips the lengths of their common seam, of the lower number first."""
    length: dict[tuple[int, int], float] = {}
    for strip in strips:
        sides = np.linalg.norm(strip.points[np.roll(strip.seam, -1)] - strip.points[strip.seam], axis=1)
        for other, side in zip(strip.beside.tolist(), sides.tolist(), strict=True):
            if other >= 0:
                length[strip.number, other] = length.get((strip.number, other), 0.0) + side
    return {(a, b): (own, length.get((b, a), own)) for (a, b), own in length.items() if a <= b}
