"""Random scenes, seeded: cables, nets, trusses and webs that are held well enough to have an equilibrium."""

from __future__ import annotations

from typing import Any

import numpy as np

Numbers = np.random.Generator
Spec = dict[str, Any]

FAMILIES = ("cable", "net", "truss", "web", "soft", "floor", "heap", "unloaded", "shell", "fold")


def random_scene(seed: int) -> Spec:
    """The scene of a seed, as `Scene.read` takes it; families take turns."""
    rng = np.random.default_rng(seed)
    family = FAMILIES[seed % len(FAMILIES)]
    spec: Spec = globals()[f"_{family}"](rng)
    spec.setdefault("settings", {})["tolerance"] = float(rng.choice([1e-6, 1e-6, 1e-9]))
    return spec


def _stiffness(rng: Numbers, count: int) -> np.ndarray:
    """Four decades in one scene."""
    return 10.0 ** rng.uniform(0.0, 4.0, count)


def _springs(rng: Numbers, pairs: Any, k: Any, factor: Any, **more: Any) -> Spec:
    pairs = np.asarray(pairs)
    return {
        "kind": "springs", "particles": pairs, "stiffness": np.broadcast_to(k, len(pairs)).copy(),
        "rest_factor": np.broadcast_to(factor, len(pairs)).copy(), **more,
    }  # fmt: skip


def _lengths(x: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    return np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)


def _others(rng: Numbers, x: np.ndarray, pairs: np.ndarray, size: float) -> list[Spec]:
    """Ties that may go slack, props that may lose contact, springs beyond their cutoffs, and yielding ones.

    A tie's lower cutoff and a prop's upper cutoff are at its rest length, where the force is zero: no jump there.
    """

    def some(count: int) -> np.ndarray:
        chosen = pairs[rng.choice(len(pairs), min(count, len(pairs)), replace=False)]
        hop = rng.integers(0, len(x), (count, 2))
        hop = hop[hop[:, 0] != hop[:, 1]]
        return np.concatenate([chosen, hop])

    forces = []
    for kind in ("tie", "prop", "cut", "yield"):
        chosen = some(int(rng.integers(2, 5)))
        start = _lengths(x, chosen)
        k = size * rng.uniform(0.2, 2.0, len(chosen)) / start.mean()
        if kind == "tie":
            factor = rng.uniform(0.98, 1.1, len(chosen))
            forces.append(_springs(rng, chosen, k, factor, lower_cutoff=np.maximum(start * factor, 1e-9)))
        elif kind == "prop":
            factor = rng.uniform(0.85, 1.02, len(chosen))
            forces.append(_springs(rng, chosen, k, factor, upper_cutoff=np.maximum(start * factor, 1e-9)))
        elif kind == "cut":
            high = rng.random(len(chosen)) < 0.5
            above, below = np.where(high, 1e-3 * start, 0.0), np.where(high, 0.0, 1e4 * start)
            forces.append(_springs(rng, chosen, k, 0.5, upper_cutoff=above, lower_cutoff=below))
        else:
            limit = rng.uniform(1e-3, 0.02, len(chosen))
            forces.append(_springs(rng, chosen, k, rng.uniform(0.7, 0.9), plasticity=limit))
    return forces


def _loads(rng: Numbers, count: int, size: float) -> list[Spec]:
    """Downward loads on most particles, and a few that pull anywhere."""
    loaded = np.flatnonzero(rng.random(count) < 0.8)
    loaded = loaded if len(loaded) else np.arange(count)
    vectors = np.zeros((len(loaded), 3))
    vectors[:, 2] = -size * rng.uniform(0.2, 1.0, len(loaded))
    odd = rng.random(len(loaded)) < 0.2
    vectors[odd] += 0.3 * size * rng.normal(size=(int(odd.sum()), 3))
    return [{"kind": "unary", "particles": loaded, "vector": vectors}]


def _sideways(rng: Numbers, count: int, held: np.ndarray) -> list[Spec]:
    """Further anchors on some axes only."""
    others = np.setdiff1d(np.arange(count), held)
    if len(others) < 4:
        return []
    axes = str(rng.choice(["x", "y", "z", "xy", "xz", "yz"]))
    return [{"name": "rail", "particles": rng.choice(others, 2, replace=False), "axes": axes}]


def _cable(rng: Numbers) -> Spec:
    n = int(rng.integers(5, 30))
    span = rng.uniform(1.0, 20.0)
    x = np.zeros((n, 3))
    x[:, 0] = np.linspace(0.0, span, n)
    x[1:-1] += 0.02 * span / n * rng.normal(size=(n - 2, 3))
    x[-1, 2] = rng.uniform(-0.3, 0.3) * span
    pairs = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    k = _stiffness(rng, n - 1)
    size = k.min() * span * rng.uniform(0.05, 0.5) / n
    forces = [_springs(rng, pairs, k, rng.uniform(0.6, 1.2)), *_others(rng, x, pairs, size), *_loads(rng, n, size)]
    return {"particles": x, "forces": forces, "anchors": [{"name": "end", "particles": [0, n - 1]}]}


def _grid(rng: Numbers, low: int = 3, high: int = 8) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[int, int]]:
    """Points, edges and diagonals of a slightly irregular grid."""
    a, b = (int(c) for c in rng.integers(low, high, 2))
    step = rng.uniform(0.3, 2.0)
    number = np.arange(a * b).reshape(a, b)
    x = np.zeros((a * b, 3))
    x[:, :2] = np.stack(np.meshgrid(np.arange(a), np.arange(b), indexing="ij"), axis=-1).reshape(-1, 2) * step
    x += 0.05 * step * rng.normal(size=x.shape)
    pairs = [np.column_stack([number[:-1].ravel(), number[1:].ravel()])]
    pairs.append(np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()]))
    cross = [np.column_stack([number[:-1, :-1].ravel(), number[1:, 1:].ravel()])]
    cross.append(np.column_stack([number[1:, :-1].ravel(), number[:-1, 1:].ravel()]))
    return x, np.concatenate(pairs), np.concatenate(cross), (a, b)


def _rim(rng: Numbers, shape: tuple[int, int]) -> np.ndarray:
    number = np.arange(shape[0] * shape[1]).reshape(shape)
    if rng.random() < 0.5:
        return np.array([number[0, 0], number[0, -1], number[-1, 0], number[-1, -1]])
    return np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))


def _net(rng: Numbers) -> Spec:
    x, pairs, cross, shape = _grid(rng)
    held = _rim(rng, shape)
    k = _stiffness(rng, len(pairs))
    size = float(np.median(k)) * float(_lengths(x, pairs).mean()) * rng.uniform(0.002, 0.05)
    forces = [
        _springs(rng, pairs, k, rng.uniform(0.5, 1.05)),
        *_others(rng, x, np.concatenate([pairs, cross]), size),
        *_loads(rng, len(x), size),
    ]
    return {
        "particles": x, "forces": forces,
        "anchors": [{"name": "rim", "particles": held}, *_sideways(rng, len(x), held)],
    }  # fmt: skip


def _double_layer(rng: Numbers) -> tuple[np.ndarray, np.ndarray, int]:
    """Two braced grids, joined: a body that keeps its shape."""
    x, pairs, cross, _ = _grid(rng, 3, 5)
    n = len(x)
    deep = float(_lengths(x, pairs).mean())
    both = np.concatenate([x, x + np.array([0.0, 0.0, deep])])
    upright = np.column_stack([np.arange(n), np.arange(n) + n])
    edges = np.concatenate([pairs, cross])
    return both, np.concatenate([edges, edges + n, upright, edges + np.array([0, n]), edges + np.array([n, 0])]), n


def _truss(rng: Numbers) -> Spec:
    x, pairs, n = _double_layer(rng)
    held = rng.choice(n, 4, replace=False)
    k = 100.0 * _stiffness(rng, len(pairs))
    size = float(np.median(k)) * rng.uniform(1e-5, 1e-3)
    forces = [
        _springs(rng, pairs, k, rng.uniform(0.999, 1.001, len(pairs))),
        *_others(rng, x, pairs, size), *_loads(rng, len(x), size),
    ]  # fmt: skip
    anchors = [{"name": "foot", "particles": held}, *_sideways(rng, len(x), held)]
    return {"particles": x, "forces": forces, "anchors": anchors}


def _neighbours(x: np.ndarray, count: int) -> np.ndarray:
    """Every point joined to its nearest ones, and all of them in one chain."""
    apart = np.linalg.norm(x[:, None] - x[None], axis=2)
    near = np.argsort(apart, axis=1)[:, 1 : count + 1]
    pairs = np.column_stack([np.repeat(np.arange(len(x)), count), near.ravel()])
    chain = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    return np.unique(np.sort(np.concatenate([pairs, chain]), axis=1), axis=0)


def _web(rng: Numbers) -> Spec:
    n = int(rng.integers(10, 45))
    x = rng.uniform(-2.0, 2.0, (n, 3))
    pairs = _neighbours(x, 4)
    held = rng.choice(n, max(4, n // 5), replace=False)
    k = _stiffness(rng, len(pairs))
    size = float(np.median(k)) * rng.uniform(0.002, 0.1)
    forces = [
        _springs(rng, pairs, k, rng.uniform(0.2, 0.9, len(pairs))),
        *_others(rng, x, pairs, size), *_loads(rng, n, size),
    ]  # fmt: skip
    anchors = [{"name": "held", "particles": held}, *_sideways(rng, n, held)]
    return {"particles": x, "forces": forces, "anchors": anchors}


def _soft(rng: Numbers) -> Spec:
    """Held by springs to targets instead of anchors."""
    spec = _net(rng)
    held = np.asarray(spec["anchors"][0]["particles"])
    strength = float(np.median(spec["forces"][0]["stiffness"])) * 10.0 ** rng.uniform(-1.0, 1.0, len(held))
    targets = spec["particles"][held] + 0.1 * rng.normal(size=(len(held), 3))
    spec["forces"].append({"kind": "anchor_spring", "particles": held, "targets": targets, "strength": strength})
    spec["anchors"] = [{"name": "one", "particles": held[:1], "axes": str(rng.choice(["x", "z", "xyz"]))}]
    return spec


def _ground(rng: Numbers, x: np.ndarray, height: float) -> Spec:
    normal = np.array([0.0, 0.0, 1.0]) + rng.choice([0.0, 0.05]) * rng.normal(size=3)
    point = np.array([x[:, 0].mean(), x[:, 1].mean(), height])
    return {
        "point": point, "normal": normal, "restitution": rng.uniform(0.0, 0.9),
        "static_friction": rng.uniform(0.2, 1.0), "kinetic_friction": rng.uniform(0.1, 0.2),
    }  # fmt: skip


def _floor(rng: Numbers) -> Spec:
    """A net or cable that sags onto a floor close below."""
    spec = [_net, _net, _cable][int(rng.integers(3))](rng)
    x = spec["particles"]
    spec["settings"] = {"floor": _ground(rng, x, x[:, 2].min() - 0.003 * np.ptp(x[:, 0]))}
    spec["forces"][-1]["vector"][:, 2] *= 30.0
    return spec


def _heap(rng: Numbers) -> Spec:
    """A body that nothing holds, let fall on a floor that is rough enough to keep it."""
    x, pairs, n = _double_layer(rng)
    k = 100.0 * _stiffness(rng, len(pairs))
    size = float(np.median(k)) * rng.uniform(1e-5, 1e-3)
    down = {"kind": "self_weight", "total": size * len(x)}
    ground = _ground(rng, x, x[:n, 2].min() - 0.1)
    ground.update(static_friction=rng.uniform(0.5, 1.0))
    body = _springs(rng, pairs, k, rng.uniform(0.999, 1.001, len(pairs)))
    return {"particles": x, "forces": [body, down], "anchors": [], "settings": {"floor": ground}}


def _unloaded(rng: Numbers) -> Spec:
    """A pre-tensioned web or net: no loads at all."""
    spec = [_net, _web][int(rng.integers(2))](rng)
    spec["forces"] = [f for f in spec["forces"] if f["kind"] != "unary"]
    factor = spec["forces"][0]["rest_factor"]
    spec["forces"][0]["rest_factor"] = np.minimum(factor, 0.85)
    return spec


def _skin(rng: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[int, int]]:
    """Points, triangles and edges of an irregular, slightly curved grid."""
    x, pairs, cross, (a, b) = _grid(rng)
    number = np.arange(a * b).reshape(a, b)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return x, quads, np.concatenate([pairs, cross[: len(quads)]]), (a, b)


def _shell(rng: Numbers) -> Spec:
    """A net whose faces resist bending."""
    x, quads, edges, shape = _skin(rng)
    faces = np.concatenate([quads[:, [0, 1, 2, 2]], quads[:, [0, 2, 3, 3]]])
    held = _rim(rng, shape)
    k = _stiffness(rng, len(edges))
    size = float(np.median(k)) * float(_lengths(x, edges).mean()) * rng.uniform(0.002, 0.05)
    return {
        "particles": x, "meshes": {"skin": {"vertices": x, "faces": faces}},
        "forces": [
            _springs(rng, edges, k, rng.uniform(0.7, 1.02)), {"kind": "shell", "mesh": "skin"},
            *_loads(rng, len(x), size),
        ],
        "anchors": [{"name": "rim", "particles": held}, *_sideways(rng, len(x), held)],
    }  # fmt: skip


def _fold(rng: Numbers) -> Spec:
    """Triangles folded along the diagonals of a grid and the edges between its cells, with hinges there."""
    x, quads, edges, (a, b) = _skin(rng)
    x[:, 2] += 0.2 * rng.normal(size=len(x)) * _lengths(x, edges).mean()
    number = np.arange(a * b).reshape(a, b)
    hinges = [[p, r, q, s] for p, q, r, s in quads]
    hinges += [[number[i, j], number[i, j + 1], number[i + 1, j + 1], number[i - 1, j]]
               for i in range(1, a - 1) for j in range(b - 1)]  # fmt: skip
    hinges += [[number[i, j], number[i + 1, j], number[i, j - 1], number[i + 1, j + 1]]
               for i in range(a - 1) for j in range(1, b - 1)]  # fmt: skip
    held = _rim(rng, (a, b))
    k = 100.0 * _stiffness(rng, len(edges))
    size = float(np.median(k)) * float(_lengths(x, edges).mean()) * rng.uniform(1e-5, 1e-3)
    strength = size * _lengths(x, edges).mean() * 10.0 ** rng.uniform(-1.0, 1.0, len(hinges))
    bending = {"kind": "hinge", "particles": np.array(hinges), "strength": strength}
    bending["angle_factor"] = rng.uniform(0.5, 1.0)
    return {
        "particles": x, "forces": [_springs(rng, edges, k, 1.0), bending, *_loads(rng, len(x), size)],
        "anchors": [{"name": "rim", "particles": held}, *_sideways(rng, len(x), held)],
    }  # fmt: skip
