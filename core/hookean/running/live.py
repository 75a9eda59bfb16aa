"""Live films: soap films whose mesh is made again while they relax, so that triangles keep one size.

Rounds of two steps: the film relaxes on the mesh it has; then long edges are split, short ones collapsed, others
flipped, and vertices spread along the surface. Rims, and the seams where films meet, stay lines of the mesh; anchors go
on to hold the vertices of what they held.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.mapping import Closest
from hookean.discretize.measures import volume
from hookean.discretize.remeshing import net_of, remeshed
from hookean.discretize.triangle_nets import FIXED, FREE, Net, Table
from hookean.errors import InputError
from hookean.forces.gas import Gas
from hookean.forces.soapfilm import SoapFilm
from hookean.forces.volume import Volume
from hookean.running.result import Result, Status
from hookean.running.run import Progress, relax
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Label = frozenset[tuple[str, bool]]

KINDS = ("soapfilm", "pressure", "gas", "volume", "hydrostatic", "wind", "area_weight", "tangential_smooth")
LONG, SHORT = 1.6, 0.4  # of the length that is wanted: what the edges of a mesh that stays are between
LEAST = 0.2  # quality of a triangle of a mesh that stays
ITERATIONS = 5  # of remeshing in a round
STIFF = 1e4  # bulk modulus of a film's volume, by its tension and size
SECONDS = 120.0  # of one round of `live_film`
CORNER = np.pi / 6  # turns of rims above this stay corners


@dataclass
class _Film:
    """All films as one mesh: triangles, what meshes of the scene each belongs to and which way round, and of each
    anchor which vertices it holds."""

    mesh: Mesh
    labels: list[Label]
    of: Index
    held: list[NDArray[np.bool_]]


def relax_live(
    scene: Scene,
    length: float,
    *,
    rounds: int = 30,
    curves: Sequence[ArrayLike] = (),
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Result:
    """Relax a scene of soap films whose triangles keep edges of about `length` [length]; its result is about the last
    mesh, in `result.scene`, with the first shape of that as its start.

    The scene has films (`soapfilm`) and forces on the same meshes, or on meshes made of faces of the films (a closed
    mesh under `volume`, `gas`): pressure, hydrostatic, wind, area_weight, tangential_smooth. Volumes, and the amount of
    a gas, are those of the mesh as given. Anchors hold vertices: where they hold both ends of an edge of a rim or seam
    they hold what is between, where they hold all vertices of a film they hold all of it. New vertices of rims that are
    held on all axes lie on the edges of the last rim, or where it is within `length` of one of `curves`, polylines
    `(k, 3)` [length], on that. The run ends in equilibrium on a mesh with edges between 0.4 and 1.6 of the length, or
    after so many `rounds`. InputError for other forces, yarns, masses by particle, or an edge with more than two faces.
    """
    if not (np.isfinite(length) and length > 0.0):
        raise InputError("length", f"it is {length!r}; give a positive length")
    film = _read(scene)
    amounts = _amounts(scene)
    paths = [_path(curve, i) for i, curve in enumerate(curves)]
    while True:
        result = relax(scene, progress=progress, cancelled=cancelled)
        rounds -= 1
        film.mesh = Mesh(_moved(scene, film, result), film.mesh.faces)
        done = result.status is Status.CONVERGED and _even(film.mesh, length)
        ended = result.status in (Status.DIVERGED, Status.CANCELLED, Status.TIME_LIMIT)
        if done or ended or rounds < 1:
            return result
        film = _remeshed(film, length, scene, paths)
        scene = _scene(scene, film, amounts)


def _read(scene: Scene) -> _Film:
    """The films of a scene as one mesh."""
    _check(scene)
    names = [name for name in scene.meshes if any(getattr(f, "mesh", None) == name for f in scene.forces)]
    soap = {f.mesh for f in scene.forces if isinstance(f, SoapFilm)}
    from hookean.discretize.duplicates import unique_points
    from hookean.discretize.meshes import triangles

    every = [Mesh(np.asarray(scene.meshes[n].vertices), np.asarray(scene.meshes[n].faces)) for n in names]
    points = np.concatenate([m.vertices for m in every])
    kept, place = unique_points(points, scene.weld_tolerance)
    found: dict[tuple[int, ...], tuple[tuple[int, ...], set[tuple[str, bool]]]] = {}
    start = 0
    for name, mesh in sorted(zip(names, every, strict=True), key=lambda one: one[0] not in soap):
        start = sum(len(m.vertices) for m in every[: names.index(name)])
        for face in place[start + triangles(mesh)].tolist():
            turn = face.index(min(face))
            loop = tuple(face[turn:] + face[:turn])
            key = tuple(sorted(face))
            if key not in found and name not in soap:
                said = f"mesh {name!r} has a face that is of no film; give it a soapfilm, or other faces"
                raise InputError(f"/meshes/{name}/faces", said)
            first, label = found.setdefault(key, (loop, set()))
            label.add((name, loop == first))
    labels = sorted({frozenset(label) for _, label in found.values()}, key=sorted)
    of = np.array([labels.index(frozenset(label)) for _, label in found.values()], dtype=np.int64)
    faces = np.array([loop for loop, _ in found.values()], dtype=np.int64)
    mesh = Mesh(points[kept], faces[:, [0, 1, 2, 2]])
    return _Film(mesh, labels, of, [_holds(scene, i, mesh.vertices) for i in range(len(scene.anchors))])


def _check(scene: Scene) -> None:
    if not any(isinstance(force, SoapFilm) for force in scene.forces):
        raise InputError("/forces", "there is no soapfilm; a live relaxation needs one")
    for i, force in enumerate(scene.forces):
        if force.kind_name not in KINDS:
            known = ", ".join(KINDS)
            raise InputError(f"/forces/{i}", f"{force.kind_name} given; a film that is remeshed bears {known} only")
        if isinstance(force, SoapFilm) and (force.warp or force.weft):
            raise InputError(f"/forces/{i}/warp", "yarns run with the material; a film that is remeshed has none")
    if isinstance(scene.masses, np.ndarray) or scene.velocities is not None:
        raise InputError("/masses", "masses and velocities by particle do not fit a mesh that changes; give one mass")
    for i, item in enumerate(scene.geometry):
        if item.mesh is None:
            raise InputError(f"/geometry/{i}", "only meshes are carried by a film that is remeshed; leave it out")


def _holds(scene: Scene, number: int, vertices: Array) -> NDArray[np.bool_]:
    """Which vertices (n,) an anchor holds."""
    from scipy.spatial import cKDTree

    anchor = scene.anchors[number]
    points = np.asarray(anchor.points if anchor.particles is None else scene.particles[np.asarray(anchor.particles)])
    held = np.zeros(len(vertices), bool)
    if len(points):
        away, at = cKDTree(vertices).query(points)
        lost = np.flatnonzero(away > max(scene.weld_tolerance, 1e-12 * float(np.abs(vertices).max())))
        if len(lost):
            raise InputError(f"/anchors/{number}", f"point {lost[0]} is no vertex of a film; hold vertices of films")
        held[at] = True
    return held


def _amounts(scene: Scene) -> dict[int, float]:
    """Of each force that knows the volume at the start, what must stay: the volume, or pressure times volume."""
    found = {}
    for i, force in enumerate(scene.forces):
        if isinstance(force, Volume | Gas):
            size = volume(Mesh(scene.meshes[force.mesh].vertices, scene.meshes[force.mesh].faces))
            found[i] = size * (force.volume_factor if isinstance(force, Volume) else force.pressure)
    return found


def _path(curve: ArrayLike, number: int) -> Closest:
    points = np.asarray(curve, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2 or not np.isfinite(points).all():
        raise InputError(f"curves/{number}", "it is no polyline; give points (k, 3), two or more")
    at = np.arange(len(points) - 1)
    return Closest(points, np.stack([at, at + 1, at + 1], axis=1))


def _moved(scene: Scene, film: _Film, result: Result) -> Array:
    """Where the vertices of the film are in a result."""
    from hookean.system.system import compile

    met = compile(scene).places.meet(film.mesh.vertices)
    return np.asarray(result.particles)[met]


def _even(mesh: Mesh, length: float) -> bool:
    """Whether edges and triangles are good enough."""
    from hookean.forces.soapfilm import shapes

    t = mesh.faces[:, :3]
    sides = np.linalg.norm(mesh.vertices[t] - mesh.vertices[np.roll(t, 1, axis=1)], axis=2)
    good = shapes(mesh.vertices, np.ascontiguousarray(t))[1].min() >= LEAST
    return bool(good and sides.max() <= LONG * length and sides.min() >= SHORT * length)


def _remeshed(film: _Film, length: float, scene: Scene, paths: list[Closest]) -> _Film:
    """The film with triangles of the size that is wanted, where it is."""
    old, faces = film.mesh, film.mesh.faces[:, :3]
    table = Table(faces, len(old.vertices))
    two = table.right >= 0
    seam = ~two
    seam[two] = film.of[table.left[two] // 3] != film.of[table.right[two] // 3]
    net = net_of(old, np.pi, CORNER, seam)
    alone = [held & ~_covered(held, net, film) & (net.kinds == FREE) for held in film.held]
    for held in alone:
        net.kinds[held] = FIXED
    lines, kept = net.lines.copy(), net.kinds == FIXED
    remeshed(net, old, length, ITERATIONS)
    held = [_still_held(one, film, net, lines, kept) for one in film.held]
    of = _relabelled(net, film)
    mesh = Mesh(net.vertices, net.faces[:, [0, 1, 2, 2]])
    for region, label in enumerate(film.labels):
        inside = np.unique(faces[film.of == region])
        for number, one in enumerate(film.held):
            if label and one[inside].all() and len(inside):
                held[number][np.unique(net.faces[of == region])] = True
    fixed = np.zeros(len(net.vertices), bool)
    for number, one in enumerate(held):
        if set(scene.anchors[number].axes) == set("xyz"):
            fixed |= one
    _onto(mesh.vertices, np.flatnonzero(fixed & (net.kinds != FIXED)), paths, length)
    return _Film(mesh, film.labels, of, held)


def _covered(held: NDArray[np.bool_], net: Net, film: _Film) -> NDArray[np.bool_]:
    """Vertices of films that an anchor holds as a whole."""
    found = np.zeros(len(held), bool)
    for region in range(len(film.labels)):
        inside = np.unique(net.faces[film.of == region])
        if len(inside) and held[inside].all():
            found[inside] = True
    return found


def _still_held(
    held: NDArray[np.bool_], film: _Film, net: Net, lines: Index, kept: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which new vertices an anchor holds: those that stay where it held one, and those of lines it held."""
    from scipy.spatial import cKDTree

    x, found = film.mesh.vertices, np.zeros(len(net.vertices), bool)
    spots = x[held & kept]
    if len(spots):
        found[net.kinds == FIXED] = cKDTree(spots).query(net.vertices[net.kinds == FIXED])[0] == 0.0
    on = np.unique(net.lines)
    if len(lines) and len(on):
        near = Closest(x, lines[:, [0, 1, 1]])(net.vertices[on])[0]
        found[on] |= held[lines[near]].all(axis=1) & (net.kinds[on] != FIXED)
    return found


def _relabelled(net: Net, film: _Film) -> Index:
    """The film of each new face: faces joined across edges that are no lines are of one, most of them near it."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    table = Table(net.faces, len(net.vertices))
    joined = (table.right >= 0) & ~net.on_lines(table.edges)
    one, two = table.left[joined] // 3, table.right[joined] // 3
    size = len(net.faces)
    count, part = connected_components(coo_matrix((np.ones(len(one)), (one, two)), (size, size)), directed=False)
    near = Closest(film.mesh.vertices, film.mesh.faces[:, :3])(net.vertices[net.faces].mean(axis=1))[0]
    votes = np.zeros((count, len(film.labels)))
    np.add.at(votes, (part, film.of[near]), 1.0)
    return np.asarray(votes.argmax(axis=1)[part], dtype=np.int64)


def _onto(vertices: Array, chosen: Index, paths: list[Closest], length: float) -> None:
    """Put vertices onto the nearest curve, where one is within a length."""
    if not len(chosen) or not paths:
        return
    best = np.full(len(chosen), length)
    spots = vertices[chosen].copy()
    for path in paths:
        to = path(vertices[chosen])[1]
        away = np.linalg.norm(to - vertices[chosen], axis=1)
        spots[away < best] = to[away < best]
        best = np.minimum(best, away)
    vertices[chosen] = spots


def _scene(scene: Scene, film: _Film, amounts: dict[int, float]) -> Scene:
    """The scene with the film's mesh in the place of its own."""
    x, meshes = film.mesh.vertices, dict(scene.meshes)
    for name in {name for label in film.labels for name, _ in label}:
        faces = []
        for region, label in enumerate(film.labels):
            for own, alike in label:
                if own == name:
                    mine = film.mesh.faces[film.of == region][:, :3]
                    faces.append(mine if alike else mine[:, ::-1])
        t = np.concatenate(faces)
        meshes[name] = {"vertices": x, "faces": t}  # type: ignore[assignment]
    forces = list(scene.forces)
    for i, amount in amounts.items():
        force: Any = forces[i]
        size = volume(Mesh(x, np.asarray(meshes[force.mesh]["faces"])[:, [0, 1, 2, 2]]))  # type: ignore[index]
        change = "volume_factor" if isinstance(force, Volume) else "pressure"
        given = {name: getattr(force, name) for name in force.model_fields_set}
        forces[i] = type(force)(**{**given, change: amount / size})
    anchors = [
        {"particles": np.flatnonzero(held), "axes": anchor.axes, "name": anchor.name}
        for anchor, held in zip(scene.anchors, film.held, strict=True)
        if held.any()
    ]
    geometry = [{"name": g.name, "kind": g.kind, "mesh": g.mesh} for g in scene.geometry]
    kept = {
        n: getattr(scene, n) for n in ("units", "settings", "masses", "weld_tolerance") if n in scene.model_fields_set
    }
    return Scene(particles=x, meshes=meshes, forces=forces, anchors=anchors, geometry=geometry, **kept)


def live_film(mesh: Any, length: float, volume_factor: float = 0.0, rounds: int = 30) -> Mesh:
    """The soap film on a mesh with its rim held, made again while it relaxes: triangles with edges of about `length`.

    An open mesh is held along its rim, whose new vertices lie on the lines drawn. A closed one keeps its volume times
    `volume_factor` [-]; 0, for open meshes, leaves it free. Units of length are those of the mesh. Raises InputError
    where the film collapses, and what `relax_live` raises.
    """
    from hookean.discretize.meshes import as_mesh, naked_vertices

    given = as_mesh(mesh)
    _expect(given, length)
    if not (np.isfinite(volume_factor) and volume_factor >= 0.0):
        raise InputError("volume_factor", f"it is {volume_factor!r}; give a number of at least 0")
    if volume_factor > 0.0 and len(naked_vertices(given)):
        raise InputError("volume_factor", "an open mesh encloses no volume; give 0, or a closed mesh")
    if volume_factor == 0.0 and not len(naked_vertices(given)):
        raise InputError("volume_factor", "a closed film without a volume shrinks to a point; give one above 0")
    size = float(np.ptp(given.vertices, axis=0).max())
    forces: list[dict[str, Any]] = [{"kind": "soapfilm", "mesh": "film"}]
    if volume_factor > 0.0:
        forces.append({"kind": "volume", "mesh": "film", "stiffness": STIFF / size, "volume_factor": volume_factor})
    rim = naked_vertices(given)
    scene = Scene(
        particles=given.vertices,
        meshes={"film": {"vertices": given.vertices, "faces": given.faces}},
        forces=forces,
        anchors=[{"particles": rim}] if len(rim) else [],
        settings={"max_iterations": 5000, "time_limit": SECONDS},
    )
    result = relax_live(scene, length, rounds=rounds)
    if result.status is Status.DIVERGED or result.scene is None:
        raise InputError("mesh", f"the film collapses: {result.message}")
    found = result.scene.meshes["film"]
    return Mesh(np.asarray(result.particles), np.asarray(found.faces))


def expected_faces(mesh: Any, length: float, volume_factor: float = 0.0, rounds: int = 30) -> int:
    """About how many faces `live_film` makes at most."""
    from hookean.discretize.meshes import as_mesh

    return _expect(as_mesh(mesh), length)


def _expect(mesh: Mesh, length: float) -> int:
    from hookean.discretize import remeshing

    return remeshing.expected_faces(mesh, length)
