"""Random scenes of several parts and many kinds of force: an evaluator in plain numpy agrees with every status.

Each scene is two to four parts, far from one another, heavy beside light: springs with groups, planes, lines, locks,
volumes and spheres that touch, held, held on one axis, held by soft supports alone, or free. `make test` runs 25;
HOOKEAN_SOAK=1 all.
"""

from __future__ import annotations

from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from hookean import Result, Scene, relax
from serving import SOAK

Spec = dict[str, Any]
COUNT = 500 if SOAK else 25
SOLVERS = ("auto", "auto", "newton", "relaxation")
EPS = 1.1e-16


def lined(x: np.ndarray, pairs: Any) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors along lines, and lengths."""
    d = x[np.asarray(pairs)[:, 1]] - x[np.asarray(pairs)[:, 0]]
    length = np.linalg.norm(d, axis=1)
    return d / np.where(length > 0.0, length, 1.0)[:, None], length


def pulled(force: Spec, x: np.ndarray, start: np.ndarray) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """What the elements of a force put on particles: their numbers, forces (m, 3) and a stiffness that each feels."""
    kind, at = force["kind"], np.asarray(force.get("particles", []))
    if kind in ("springs", "constant_tension", "equal_length"):
        along, length = lined(x, at)
        if kind == "springs":
            tension, k = force["stiffness"] * (length - lined(start, at)[1] * force["rest_factor"]), force["stiffness"]
        elif kind == "constant_tension":
            tension, k = np.full(len(at), force["tension"]), force["tension"] / float(length.min())
        else:
            tension, k = force["stiffness"] * (length - length.mean()), force["stiffness"]
        pulls = tension[:, None] * along
        return [(pair, np.stack([f, -f]), k) for pair, f in zip(at, pulls, strict=True)]
    if kind in ("direction", "translation_lock"):
        d = x[at[:, 1]] - x[at[:, 0]]
        if kind == "direction":
            off = d - np.outer(d @ force["direction"], force["direction"])
        else:
            off = d - (start[at[:, 1]] - start[at[:, 0]])
        return [
            (pair, force["stiffness"] * np.stack([f, -f]), force["stiffness"]) for pair, f in zip(at, off, strict=True)
        ]
    if kind == "collide":
        found, r, k = [], force["radius"], force["strength"]
        for a, b in combinations(at.tolist(), 2):
            (along,), (apart,) = lined(x, [[a, b]])
            if apart < 2.0 * r:
                f = k * (2.0 * r - apart) * along
                found.append((np.array([a, b]), np.stack([-f, f]), k))
        return found
    if kind == "co_planar":
        y = x[at] - x[at].mean(axis=0)
        normal = np.linalg.svd(y)[2][2]
        return [(at, -force["strength"] * np.outer(y @ normal, normal), force["strength"])]
    if kind == "volume":
        hull = force["faces"]
        a, b, c = (x[hull[:, i]] for i in range(3))
        flux = np.cross(b - a, c - a) / 6.0
        size = [float(np.linalg.det(p[hull] - p.mean(axis=0)).sum() / 6.0) for p in (x, start)]
        target = size[1] * force["volume_factor"]
        pressure = force["stiffness"] * (target - size[0]) / target
        reach = float(np.ptp(x[np.unique(hull)], axis=0).max())
        k = force["stiffness"] * reach**4 / target
        return [(face, np.tile(pressure * f, (3, 1)), k) for face, f in zip(hull, flux, strict=True)]
    raise KeyError(kind)


def supported(force: Spec, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """What a soft support puts on particles: their numbers, forces, the directions (3, 3) it can push in, and k."""
    at, k = np.asarray(force["particles"]), force["strength"]
    if force["kind"] == "anchor_spring":
        return at, k * (np.asarray(force["targets"]) - x[at]), np.eye(3), k
    along = np.asarray(force.get("normal", force.get("direction")))
    way = np.outer(along, along)
    way = way if force["kind"] == "pull_to_plane" else np.eye(3) - way
    return at, -k * (x[at] - force["origin"]) @ way, way, k


class Judge:
    """What is left at each particle, and of each component its scale, its rounding and whether it is adrift."""

    def __init__(self, spec: Spec, x: np.ndarray, before: Judge | None = None) -> None:
        n, start = len(x), np.asarray(spec["particles"])
        self.free = np.ones((n, 3))
        for anchor in spec["anchors"]:
            for axis in anchor["axes"]:
                self.free[anchor["particles"], "xyz".index(axis)] = 0.0
        f, loads, w, reach = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), np.zeros(n)
        links, sizes, ways = [], [], np.zeros((n, 3, 3))
        ways[np.arange(n)[:, None], range(3), range(3)] += 1.0 - self.free
        moving = self.free.any(axis=1)
        for force in spec["forces"]:
            if force["kind"] == "unary":
                np.add.at(loads, force["particles"], np.broadcast_to(force["vector"], (len(force["particles"]), 3)))
            elif force["kind"] in ("anchor_spring", "pull_to_plane", "pull_to_line"):
                at, push, way, k = supported(force, x)
                f[at] += push
                ways[at] += way
                w[at] += k
                reach[at] = np.maximum(reach[at], np.abs(x[at]).max(axis=1))
                sizes += [(p, float(np.linalg.norm(q))) for p, q in zip(at, push, strict=True)]
            else:
                if force["kind"] in ("collide", "volume"):  # their particles are one component, touching or not
                    at = np.unique(force.get("faces", force.get("particles")))
                    links += [(a, b) for a, b in pairwise(at) if moving[a] and moving[b]]
                for at, push, k in pulled(force, x, start):
                    np.add.at(f, at, push)
                    w[at] += 2.0 * k
                    reach[at] = np.maximum(reach[at], np.abs(x[at]).max())
                    inner = at[moving[at]]
                    links += [(inner[0], p) for p in inner[1:]]
                    if len(inner) < len(at):
                        ways[inner] += np.eye(3)
                    sizes.append((int(inner[0]) if len(inner) else -1, float(np.linalg.norm(push, axis=1).max())))
        a, b = np.array(links, int).reshape(-1, 2).T
        graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(n, n))
        label = connected_components(graph, directed=False)[1]
        self.left = np.linalg.norm((f + loads) * self.free, axis=1)
        self.loads, self.label = loads, np.where(moving, label, -1)
        self.noise = EPS * (w * reach + np.abs(f).max(axis=1) + np.linalg.norm(loads, axis=1))
        self.scale, self.sizes, self.adrift = np.zeros(n), np.zeros(n), False
        for part in np.unique(self.label[moving]):
            mine = self.label == part
            own = np.linalg.norm(loads * self.free, axis=1)[mine]
            forces = [size for p, size in sizes if p >= 0 and self.label[p] == part]
            size = float(np.mean(forces)) if forces else 0.0
            self.sizes[mine] = size
            # without loads at least a thousandth of the largest on the way, which was up to five times the start
            least = 5e-3 * float(before.sizes[mine].max()) if before else 0.0
            self.scale[mine] = own[own > 0.0].mean() if own.any() else max(size, least) or 1.0
            values, vectors = np.linalg.eigh(ways[mine].sum(axis=0))
            loose = vectors[:, values <= 1e-9 * max(values[-1], 1e-300)]
            self.adrift |= bool(np.abs(loose.T @ loads[mine].sum(axis=0)).max(initial=0.0) > 1e-6 * own.sum())

    def verdict(self, tolerance: float) -> str:
        if self.adrift:
            return "adrift"
        over = self.left > np.maximum(1.02 * tolerance * self.scale, 8.0 * self.noise)
        return "moving" if over.any() else "rest"


def cage(rng: np.random.Generator, load: float) -> tuple[np.ndarray, list[Spec]]:
    """Points on a sphere, their hull as springs, and something more on them."""
    x = rng.normal(size=(int(rng.integers(6, 12)), 3))
    x /= np.linalg.norm(x, axis=1)[:, None] / 2.0
    hull = ConvexHull(x)
    faces = hull.simplices.copy()
    out = np.cross(x[faces[:, 1]] - x[faces[:, 0]], x[faces[:, 2]] - x[faces[:, 0]])
    turned = (out * hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[turned] = faces[turned][:, ::-1]
    pairs = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    k = load * 10.0 ** rng.uniform(1.0, 3.0)
    forces: list[Spec] = [{"kind": "springs", "particles": pairs, "stiffness": k, "rest_factor": 0.98}]
    more: list[Spec] = [
        {"kind": "volume", "faces": faces, "stiffness": 0.1 * k, "volume_factor": 1.05},
        {"kind": "equal_length", "particles": pairs[: len(pairs) // 2], "stiffness": 0.3 * k},
        {"kind": "co_planar", "particles": np.arange(4), "strength": 0.2 * k},
        {"kind": "constant_tension", "particles": pairs[:3], "tension": 0.2 * load},
        {"kind": "direction", "particles": pairs[:2], "direction": np.eye(3)[0], "stiffness": 0.1 * k},
        {"kind": "translation_lock", "particles": pairs[:2], "stiffness": 0.1 * k},
    ]
    chosen = rng.choice(len(more), 3, replace=False)
    return x, forces + [more[i] for i in chosen]


def crowd(rng: np.random.Generator, load: float) -> tuple[np.ndarray, list[Spec]]:
    """Spheres in disorder, each on springs to the next, that overlap here and there."""
    x = rng.uniform(-2.0, 2.0, (int(rng.integers(4, 9)), 3))
    pairs = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    k = load * 10.0 ** rng.uniform(1.0, 2.0)
    springs = {"kind": "springs", "particles": pairs, "stiffness": k, "rest_factor": 1.0}
    return x, [springs, {"kind": "collide", "particles": np.arange(len(x)), "radius": 0.7, "strength": k}]


def holds(rng: np.random.Generator, x: np.ndarray, k: float) -> tuple[list[Spec], list[Spec]]:
    """Anchors and soft supports of a part: many, one axis, a plane and a line, or none."""
    n, way = len(x), rng.random()
    axis = np.eye(3)[rng.integers(3)]
    if way < 0.45:
        return [{"particles": rng.choice(n, 3, replace=False), "axes": "xyz"}], []
    if way < 0.55:
        return [{"particles": rng.choice(n, 2, replace=False), "axes": str(rng.choice(["x", "yz"]))}], []
    plane = {"kind": "pull_to_plane", "particles": rng.choice(n, 3, replace=False), "origin": x[0], "normal": axis}
    line = {"kind": "pull_to_line", "particles": rng.choice(n, 2, replace=False), "origin": x[1], "direction": axis}
    soft = {"kind": "anchor_spring", "particles": np.arange(n), "targets": x.copy()}
    if way < 0.9:
        return [], [{**one, "strength": k} for one in ([soft], [plane], [line], [plane, line])[int(rng.integers(4))]]
    return [], []


def scene_of(seed: int) -> Spec:
    """Two to four parts of a seed."""
    rng = np.random.default_rng([29, seed])
    places, forces, anchors, meshes, first = [], [], [], {}, 0
    for part in range(int(rng.integers(2, 5))):
        load = 10.0 ** rng.uniform(-3.0, 4.0)
        x, own = (cage if rng.random() < 0.6 else crowd)(rng, load)
        x = x + rng.uniform(-1.0, 1.0, 3) * 10.0 ** rng.uniform(0.0, 3.0)
        held, soft = holds(rng, x, 10.0 * load)
        vectors = load * rng.normal(size=x.shape) * (rng.random() < 0.8)
        if rng.random() < 0.3:
            vectors -= vectors.mean(axis=0)
        loads = [{"kind": "unary", "particles": np.arange(len(x)), "vector": vectors}] if vectors.any() else []
        for force in own + soft + loads:
            for name in ("particles", "faces"):
                if name in force:
                    force[name] = force[name] + first
            if "faces" in force:
                force["mesh"] = f"part {part}"
                meshes[force["mesh"]] = force["faces"]
            forces.append(force)
        anchors += [{**one, "particles": one["particles"] + first} for one in held]
        places.append(x)
        first += len(x)
    settings = {"solver": str(rng.choice(SOLVERS)), "max_iterations": 20_000}
    return {
        "particles": np.concatenate(places),
        "forces": forces,
        "anchors": anchors,
        "settings": settings,
        "_m": meshes,
    }


def judged(spec: Spec, x: np.ndarray) -> str:
    """What a person would call a shape: "rest", "moving" or "adrift"."""
    return Judge(spec, x, Judge(spec, spec["particles"])).verdict(1e-6)


def solved(spec: Spec) -> Result:
    """The scene relaxed; meshes are those of its volumes, with its particles as vertices."""
    x, given = spec["particles"], {}
    for name, faces in spec["_m"].items():
        used, inverse = np.unique(faces, return_inverse=True)
        given[name] = {"vertices": x[used], "faces": inverse.reshape(faces.shape)}
    forces = [{k: v for k, v in force.items() if k != "faces"} for force in spec["forces"]]
    return relax(Scene.read({**{k: v for k, v in spec.items() if k != "_m"}, "forces": forces, "meshes": given}))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(COUNT))
def test_an_evaluator_of_its_own_agrees_with_the_status(seed: int) -> None:
    """Converged is at rest in every part, and none adrift; what is at rest is called so, unless iterations, accuracy or
    a shape that no force can hold ended the run."""
    spec = scene_of(seed)
    found = solved(spec)
    verdict = judged(spec, found.particles)
    if found.converged:
        assert verdict == "rest", found.message
    elif found.status == "stalled":
        other = "position_tolerance" in found.message or "Rounding alone" in found.message
        assert verdict != "rest" or other, found.message
    if verdict == "adrift":
        assert "Nothing supports" in found.message


@pytest.mark.soak
def test_the_evaluator_notices_what_is_not_at_rest() -> None:
    """Negative control: of 10 scenes at rest, one particle moved by a thousandth breaks the verdict."""
    seen = 0
    for seed in range(20):
        spec = scene_of(seed)
        found = solved(spec)
        if found.converged and seen < 10:
            x = found.particles.copy()
            particle = int(np.argmax(Judge(spec, x).free.min(axis=1)))
            x[particle] += 1e-3
            assert judged(spec, x) == "moving", seed
            seen += 1
    assert seen >= 5
