"""Random nets that solvers find hard, seeded: slack, stiff, nearly singular, in pieces, mechanisms, of unequal
stiffness. Springs have no cutoffs, so that each net has an energy without jumps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..laws.scenes import random_scene

Numbers = np.random.Generator
Spec = dict[str, Any]
Family = Callable[[Numbers, int], Spec]
SMALL, USUAL, LARGE = 200, 2_000, 20_000
"""Most particles of the first twenty nets, of the others, and of the last ten."""


def family(seed: int) -> str:
    """Which family the net of a seed is of; they take turns."""
    names = LARGE_FAMILIES if seed >= 190 else tuple(FAMILIES)
    return names[seed % len(names)]


def random_net(seed: int) -> Spec:
    """The net of a seed, as `Scene.read` takes it."""
    rng = np.random.default_rng([6, seed])
    least, most = (5_000, LARGE) if seed >= 190 else (10, SMALL if seed < 20 else USUAL)
    n = int(np.exp(rng.uniform(np.log(least), np.log(most))))
    return FAMILIES[family(seed)](rng, n)


def lattice(rng: Numbers, n: int, bumps: float = 0.05) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """About n points of a grid, the pairs along its two directions, and the numbers (a, b) of its points."""
    a = max(3, round(np.sqrt(n * rng.uniform(0.3, 1.0))))
    b = max(3, round(n / a))
    number = np.arange(a * b).reshape(a, b)
    x = np.zeros((a * b, 3))
    x[:, :2] = np.stack(np.meshgrid(np.arange(a), np.arange(b), indexing="ij"), axis=-1).reshape(-1, 2)
    x += bumps * rng.normal(size=x.shape)
    along = np.column_stack([number[:-1].ravel(), number[1:].ravel()])
    return x, np.concatenate([along, np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()])]), number


def crossing(number: np.ndarray) -> np.ndarray:
    """One diagonal of each cell of a grid."""
    return np.column_stack([number[:-1, :-1].ravel(), number[1:, 1:].ravel()])


def rim(number: np.ndarray) -> np.ndarray:
    return np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))


def corners(number: np.ndarray) -> np.ndarray:
    return number[[0, 0, -1, -1], [0, -1, 0, -1]]


def springs(pairs: np.ndarray, stiffness: Any, factor: Any) -> Spec:
    full = np.ones(len(pairs))
    return {"kind": "springs", "particles": pairs, "stiffness": stiffness * full, "rest_factor": factor * full}


def loads(particles: np.ndarray, vectors: Any) -> Spec:
    return {"kind": "unary", "particles": particles, "vector": vectors * np.ones((len(particles), 1))}


def down(rng: Numbers, count: int, size: float = 1.0) -> np.ndarray:
    """Unequal loads downwards, a little aslant."""
    vectors = 0.1 * size * rng.normal(size=(count, 3))
    vectors[:, 2] -= size * rng.uniform(0.5, 1.5, count)
    return vectors


def net(x: np.ndarray, held: np.ndarray, *forces: Spec, **more: Any) -> Spec:
    return {"particles": x, "forces": list(forces), "anchors": [{"particles": held}], **more}


def slack(rng: Numbers, n: int) -> Spec:
    """Longer than what it spans by up to a third."""
    x, pairs, number = lattice(rng, n)
    held = rim(number) if rng.random() < 0.5 else corners(number)
    factor = rng.uniform(1.02, 1.3)
    return net(x, held, springs(pairs, 10.0 ** rng.uniform(1, 3), factor), loads(np.arange(len(x)), down(rng, len(x))))


def stiff(rng: Numbers, n: int) -> Spec:
    """Up to 1e5 times stiffer than loaded, held at a few points only."""
    x, pairs, number = lattice(rng, n)
    held = rim(number) if rng.random() < 0.5 else corners(number)
    factor = rng.uniform(0.99, 1.01)
    return net(x, held, springs(pairs, 10.0 ** rng.uniform(3, 5), factor), loads(np.arange(len(x)), down(rng, len(x))))


def nearly_singular(rng: Numbers, n: int) -> Spec:
    """Hardly stretched across a frame: stiff along, 1e-7 to 1e-3 of that across."""
    x, pairs, number = lattice(rng, n, 0.0)
    strain = 10.0 ** rng.uniform(-7, -3)
    across = loads(np.arange(len(x)), strain * rng.normal(size=(len(x), 3)) * [0, 0, 1])
    return net(x, rim(number), springs(pairs, 100.0, 1.0 - strain), across)


def in_pieces(rng: Numbers, n: int) -> Spec:
    """A net, a chain from one anchor, a piece that nothing holds or loads, and particles that nothing joins."""
    x, pairs, number = lattice(rng, max(n // 2, 9))
    m, k = len(x), max(n // 4, 3)
    chain = np.column_stack([np.arange(k), np.zeros(k), np.full(k, 5.0)])
    loose, _, _ = lattice(rng, max(n // 4, 9))
    _, inner, count = lattice(rng, 9)
    body = 0.8 * loose[: count.size] + [0, 0, 20.0]
    links = np.column_stack([np.arange(k - 1), np.arange(1, k)]) + m
    whole = np.concatenate([x, chain, body, rng.normal(size=(5, 3)) - [0, 0, 9.0]])
    inside = np.concatenate([inner, crossing(count)])
    inside = inside[(inside < len(body)).all(axis=1)] + m + k
    uneven = rng.uniform(0.9, 1.1, len(inside))
    three = springs(pairs, 200.0, 0.9), springs(links, 500.0, 1.0), springs(inside, 50.0, uneven)
    held = np.concatenate([corners(number), [m]])
    return net(whole, held, *three, loads(np.arange(m + k), down(rng, m + k)))


def flat(rng: Numbers, n: int) -> Spec:
    """A flat net without stress under a load across it: a mechanism, to first order."""
    x, pairs, number = lattice(rng, n, 0.0)
    size = np.ones(len(x)) if rng.random() < 0.5 else rng.uniform(0.0, 2.0, len(x))
    across = loads(np.arange(len(x)), size[:, None] * [0, 0, -1.0])
    return net(x, rim(number), springs(pairs, 10.0 ** rng.uniform(1, 4), 1.0), across)


def chain(rng: Numbers, n: int) -> Spec:
    """A chain in a line, slack or not, held at both ends or at one."""
    n = min(n, 500)
    x = np.column_stack([np.arange(n), np.zeros((n, 2))]).astype(float)
    pairs = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    held = np.array([0, n - 1] if rng.random() < 0.6 else [0])
    links = springs(pairs, 10.0 ** rng.uniform(2, 5), rng.uniform(0.95, 1.2))
    return net(x, held, links, loads(np.arange(n), [0, 0, -1.0]))


def tower(rng: Numbers, n: int) -> Spec:
    """A braced tower, loaded on top by a part of what it buckles under, or by more."""
    levels = max(2, min(n // 4, 60))
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    x = np.concatenate([np.column_stack([square, np.full(4, level)]) for level in range(levels)])
    x += 0.01 * rng.normal(size=x.shape)
    near = np.linalg.norm(x[:, None] - x[None], axis=2)
    pairs = np.argwhere(np.triu((near > 0) & (near < 1.55)))
    buckles = np.pi**2 * 100.0 / (2.0 * levels) ** 2  # Euler's load of a cantilever of E I 100
    top = np.zeros((4, 3))
    top[:, 2] = -buckles * rng.uniform(0.05, 0.6)
    top += 0.01 * buckles * rng.normal(size=(4, 3))
    return net(x, np.arange(4), springs(pairs, 100.0, 1.0), loads(np.arange(len(x) - 4, len(x)), top))


def unequal(rng: Numbers, n: int) -> Spec:
    """Stiffnesses of four decades side by side."""
    x, pairs, number = lattice(rng, n)
    held = rim(number) if rng.random() < 0.5 else corners(number)
    stiffness = 10.0 ** rng.uniform(1, 5, len(pairs))
    factor = rng.uniform(0.6, 1.0)
    return net(x, held, springs(pairs, stiffness, factor), loads(np.arange(len(x)), down(rng, len(x), 10.0)))


def soft(rng: Numbers, n: int) -> Spec:
    """Held by anchor springs, one particle on a rail."""
    x, pairs, number = lattice(rng, n)
    held = rim(number)
    strength = 10.0 ** rng.uniform(0, 3, len(held))
    pulls = {"kind": "anchor_spring", "particles": held, "targets": 1.1 * x[held], "strength": strength}
    spec = net(
        x, held[:1], springs(pairs, 100.0, rng.uniform(0.7, 1.0)), pulls, loads(np.arange(len(x)), down(rng, len(x)))
    )
    spec["anchors"][0]["axes"] = "xy"
    return spec


def folded(rng: Numbers, n: int) -> Spec:
    """Triangles with hinges between them."""
    del n
    return {**random_scene(10 * int(rng.integers(1000)) + 9), "settings": {}}


def on_floor(rng: Numbers, n: int) -> Spec:
    """A net that sags onto a floor without friction."""
    x, pairs, number = lattice(rng, n)
    spec = net(x, corners(number), springs(pairs, 100.0, rng.uniform(0.9, 1.0)),
               loads(np.arange(len(x)), down(rng, len(x))))  # fmt: skip
    ground = {
        "point": [0, 0, -rng.uniform(0.5, 2.0)],
        "normal": [0, 0, 1.0],
        "static_friction": 0.0,
        "kinetic_friction": 0.0,
    }
    return {**spec, "settings": {"floor": ground}}


def web(rng: Numbers, n: int) -> Spec:
    """Points in space, each tied to its nearest ones, a part of them held."""
    n = min(n, 1_000)
    x = rng.uniform(-1, 1, (n, 3)) * n ** (1 / 3)
    near = np.argsort(np.linalg.norm(x[:, None] - x[None], axis=2), axis=1)[:, 1:6]
    pairs = np.unique(np.sort(np.column_stack([np.repeat(np.arange(n), 5), near.ravel()]), axis=1), axis=0)
    held = rng.choice(n, max(4, n // 5), replace=False)
    factor = rng.uniform(0.2, 0.9, len(pairs))
    return net(
        x, held, springs(pairs, 10.0 ** rng.uniform(0, 2, len(pairs)), factor), loads(np.arange(n), down(rng, n))
    )


def pressed(rng: Numbers, n: int) -> Spec:
    """A net too long for its frame, a thousandth of a cell from flat and not loaded: it has to buckle."""
    x, pairs, number = lattice(rng, min(n, 400), 0.0)
    x[:, 2] += 1e-3 * rng.normal(size=len(x))
    return net(x, rim(number), springs(np.concatenate([pairs, crossing(number)]), 100.0, rng.uniform(1.01, 1.1)))


FAMILIES: dict[str, Family] = {
    f.__name__: f
    for f in (
        slack,
        stiff,
        nearly_singular,
        in_pieces,
        flat,
        chain,
        tower,
        unequal,
        soft,
        folded,
        on_floor,
        web,
        pressed,
    )
}  # fmt: skip
LARGE_FAMILIES = ("stiff", "flat", "unequal", "soft", "nearly_singular", "slack")
