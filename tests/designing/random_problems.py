"""Random design problems of nets, cables and fans, with their variables as functions of a net: well posed ones, and
such that contradict themselves, have no end, cannot be met, or are badly scaled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .own_nets import AXES, Net, Quantity, measured

Rng = np.random.Generator
TWISTS = ("plain", "plain", "plain", "plain", "scaled", "scaled", "contradictory", "infeasible", "unbounded")


@dataclass
class Varied:
    """A variable: how it is given, its values at the start, between bounds, and how a net takes them."""

    given: dict[str, Any]
    start: np.ndarray
    put: Callable[[Net, np.ndarray], None]
    lower: float
    upper: float


@dataclass
class Case:
    """A problem and the net that it is about."""

    net: Net
    variables: list[Varied]
    goals: list[Quantity] = field(default_factory=list)
    constraints: list[Quantity] = field(default_factory=list)

    @property
    def start(self) -> np.ndarray:
        return np.concatenate([v.start for v in self.variables])

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        sides = [[np.full(len(v.start), side) for side in (v.lower, v.upper)] for v in self.variables]
        return np.concatenate([s[0] for s in sides]), np.concatenate([s[1] for s in sides])

    def at(self, values: np.ndarray, near: np.ndarray) -> tuple[Net, np.ndarray]:
        """The net with values of all variables, and its equilibrium near a shape."""
        net, first = self.net.copy(), 0
        for v in self.variables:
            v.put(net, values[first : first + len(v.start)])
            first += len(v.start)
        return net, net.settled(near)

    def problem(self, **settings: Any) -> dict[str, Any]:
        net = self.net
        springs = {"kind": "springs", "name": "s", "particles": net.pairs, "stiffness": net.stiffness}
        scene = {
            "particles": net.x,
            "forces": [
                {**springs, "rest_length": net.rest},
                {"kind": "unary", "name": "l", "particles": net.free, "vector": net.loads[net.free]},
            ],
            "anchors": [{"name": "a", "particles": net.held}],
            "weld_tolerance": 1e-6 * float(np.ptp(net.x, axis=0).max()),
        }
        if net.faces is not None:
            scene["meshes"] = {"m": {"vertices": net.x, "faces": net.faces}}
        return {"scene": scene, "variables": [v.given for v in self.variables], "goals": self.goals,
                "constraints": self.constraints, "settings": settings}  # fmt: skip


def net_of(rng: Rng, units: tuple[float, float] = (1.0, 1.0)) -> Net:
    """A net of quadrilaterals, a cable or a fan, under random loads, in units of length and force."""
    kind, faces = rng.choice(["net", "cable", "fan"]), None
    if kind == "net":
        n = int(rng.integers(3, 5))
        at = np.arange(n * n).reshape(n, n)
        rim = rng.random() < 0.5
        held = np.setdiff1d(at, at[1:-1, 1:-1]) if rim else np.array([0, n - 1, n * n - n, n * n - 1])
        x = np.stack([*np.divmod(at.ravel(), n), np.zeros(n * n)], axis=1) + rng.normal(0, 0.08, (n * n, 3))
        x[held, 2] += rng.normal(0, 0.5, len(held))
        pairs = np.concatenate([np.stack([at[:-1].ravel(), at[1:].ravel()], 1),
                                np.stack([at[:, :-1].ravel(), at[:, 1:].ravel()], 1)])  # fmt: skip
        pairs = pairs[~np.isin(pairs, held).all(axis=1)]
        faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    elif kind == "cable":
        n = int(rng.integers(4, 8))
        t = np.linspace(0, 1, n)
        x = np.stack([4 * t, 0 * t, -2 * t * (1 - t)], axis=1) + rng.normal(0, 0.05, (n, 3))
        held, pairs = np.array([0, n - 1]), np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    else:
        n = int(rng.integers(4, 7))
        a = np.linspace(0, 2 * np.pi, n, endpoint=False) + rng.random(n) * 0.5
        x = np.vstack([[0, 0, 0], np.stack([3 * np.cos(a), 3 * np.sin(a), rng.random(n) * 2], axis=1)])
        held, pairs = np.arange(1, n + 1), np.stack([np.zeros(n, int), np.arange(1, n + 1)], axis=1)
    stiffness = rng.uniform(5, 50, len(pairs)) if rng.random() < 0.5 else np.full(len(pairs), 20.0)
    size, force = units
    stiffness = stiffness * force / size
    net = Net(x * size, pairs, stiffness, np.zeros(len(pairs)), np.zeros_like(x), held, faces, units)
    if rng.random() < 0.5:
        net.rest = net.along(x)[1] * rng.uniform(0.5, 0.98)
    net.loads[net.free, 2] = -rng.uniform(0.5, 3, len(net.free)) * force
    if rng.random() < 0.3:
        net.loads[net.free, 0] = rng.normal(0, 1, len(net.free)) * force
    return net


def variables_of(rng: Rng, net: Net) -> list[Varied]:
    """One or two of the columns of springs, loads, and supports."""
    kinds = ["stiffness", "load", "anchor", *(["rest"] if net.rest.any() else [])]
    return [_varied(rng, net, str(kind)) for kind in rng.choice(kinds, size=int(rng.integers(1, 3)), replace=False)]


def _varied(rng: Rng, net: Net, kind: str) -> Varied:
    tie = str(rng.choice(["each", "all", "groups"]))
    if kind == "load":
        return _load(net, str(rng.choice(["z", "xz"])), tie)
    if kind == "anchor":
        return _anchor(net, str(rng.choice(["z", "xy", "x"])), tie)
    column, m = getattr(net, kind), len(net.pairs)
    groups = [np.arange(m)] if tie == "all" else [np.arange(m)[i::2] for i in (0, 1)]
    groups = [np.array([i]) for i in range(m)] if tie == "each" else groups
    for group in groups:
        column[group] = column[group].mean()
    start = np.array([column[group[0]] for group in groups])
    lower = float(start.min() * (rng.uniform(0.1, 0.9) if rng.random() < 0.8 else 1e-3))
    given: dict[str, Any] = {"force": "s", "field": "stiffness" if kind == "stiffness" else "rest_length"}
    given |= {"tie": tie if tie != "groups" else [g.tolist() for g in groups], "lower": lower}
    upper = float(start.max() * rng.uniform(1.1, 6)) if rng.random() < 0.9 else np.inf
    if np.isfinite(upper):
        given["upper"] = upper

    def put(own: Net, values: np.ndarray) -> None:
        for group, value in zip(groups, values, strict=True):
            getattr(own, kind)[group] = value

    return Varied(given, start, put, lower, upper)


def _load(net: Net, axes: str, tie: str) -> Varied:
    at = np.ix_(net.free, [AXES[a] for a in axes])
    if tie != "each":
        net.loads[at] = net.loads[at].mean(axis=0)
    start = net.loads[at].ravel() if tie == "each" else net.loads[at][0]

    def put(own: Net, values: np.ndarray) -> None:
        own.loads[at] = values.reshape(-1, len(axes))

    tie = "each" if tie == "each" else "all"
    end = 5.0 * net.units[1]
    given = {"force": "l", "field": "vector", "axes": axes, "tie": tie, "lower": -end, "upper": end}
    return Varied(given, start, put, -end, end)


def _anchor(net: Net, axes: str, tie: str) -> Varied:
    at, home = np.ix_(net.held, [AXES[a] for a in axes]), net.x.copy()
    shifts = tie != "each"
    start = np.zeros(len(axes)) if shifts else home[at].ravel()
    size = net.units[0]
    ends = (-1.0, 1.0) if shifts else (float(start.min()) / size - 0.5, float(start.max()) / size + 0.5)
    lower, upper = ends[0] * size, ends[1] * size

    def put(own: Net, values: np.ndarray) -> None:
        own.x[at] = home[at] + values if shifts else values.reshape(-1, len(axes))

    given = {"anchor": "a", "axes": axes, "tie": "all" if shifts else "each", "lower": lower, "upper": upper}
    return Varied(given, start, put, lower, upper)


def unit_of(net: Net, q: Quantity) -> float:
    """The size of a quantity's values, by its dimension."""
    length, force = net.units
    work = force * length
    sizes = {"force": force, "reaction": force, "force_density": force / length, "direction": 1.0}
    sizes |= {"load_path": work, "strain_energy": work, "area": length**2, "volume": length**3}
    return sizes.get(q["kind"], length)


def quantity_of(rng: Rng, net: Net) -> Quantity:
    kinds = ["position", "length", "force", "reaction", "load_path", "strain_energy", "direction", "offset",
             "force_density", *(["area", "volume", "planarity"] if net.faces is not None else [])]  # fmt: skip
    q: Quantity = {"kind": str(rng.choice(kinds))}
    kind = q["kind"]
    if kind in ("length", "force", "force_density", "direction", "load_path", "strain_energy"):
        q["force"] = "s"
    if kind in ("length", "force", "force_density") and (way := int(rng.integers(0, 5))) < 3:
        q[["equal", "smooth", "total"][way]] = True
    if kind == "position":
        count = min(len(net.free), int(rng.integers(1, 4)))
        q |= {"particles": rng.choice(net.free, count, replace=False).tolist(), "axes": str(rng.choice(["z", "xz"]))}
    if kind == "offset":
        q |= {"particles": net.free[:2].tolist(), "origin": [0, 0, -net.units[0]], "normal": [0.2, 0.1, 1.0]}
    if kind == "reaction":
        q |= {"anchor": "a", "axes": str(rng.choice(["xy", "z", "xyz"]))}
        if way := int(rng.integers(0, 3)):
            q[["total", "size"][way - 1]] = True
    if kind in ("area", "volume", "planarity"):
        q["mesh"] = "m"
    return q


def _goal(rng: Rng, net: Net, x: np.ndarray) -> Quantity:
    q = quantity_of(rng, net)
    own, chance = measured(net, x, q), rng.random()
    q["weight"] = float(rng.uniform(0.2, 5))
    if q["kind"] in ("load_path", "strain_energy", "area") and chance < 0.4:
        return q
    if chance < 0.15:
        return {**q, "lower": float(own.min()), "upper": float(own.min() + 0.3 * np.ptp(own))}
    if q.get("equal") or q.get("smooth") or q["kind"] == "planarity":
        return {**q, "target": 0.0}
    moved = own + rng.normal(0, 0.2, own.shape) * (np.abs(own) + 0.1 * unit_of(net, q))
    return {**q, "target": moved.tolist() if len(own) > 1 else float(own[0] * rng.uniform(0.7, 1.4))}


def _limit(rng: Rng, net: Net, x: np.ndarray) -> Quantity:
    q = quantity_of(rng, net)
    own, chance = measured(net, x, q), rng.random()
    spread = 0.1 * float(np.abs(own).max()) + 0.05 * unit_of(net, q)
    if chance < 0.4:
        return {**q, "upper": float(own.max() + rng.normal(-0.3, 1) * spread)}
    if chance < 0.8:
        return {**q, "lower": float(own.min() + rng.normal(0.3, 1) * spread)}
    if len(own) == 1:
        value = float(own[0] + rng.normal() * spread)
        return {**q, "lower": value, "upper": value}
    return {**q, "lower": float(own.min() - 0.5 * spread), "upper": float(own.max() + 0.1 * spread)}


def case_of(seed: int, twist: str = "plain") -> Case:
    """A problem by its seed."""
    rng = np.random.default_rng(seed)
    units = (10 ** rng.uniform(-4, 4), 10 ** rng.uniform(-4, 4)) if twist == "scaled" else (1.0, 1.0)
    net = net_of(rng, units)
    found = Case(net, variables_of(rng, net))
    x = net.settled(net.x)
    found.goals = [_goal(rng, net, x) for _ in range(int(rng.integers(1, 4)))]
    if rng.random() < 0.55:
        found.constraints = [_limit(rng, net, x) for _ in range(int(rng.integers(1, 3)))]
    place = {"kind": "position", "particles": [int(net.free[0])], "axes": "z"}
    height = float(x[net.free[0], 2])
    if twist == "contradictory":
        found.constraints += [{**place, "lower": height + 0.1}, {**place, "upper": height - 0.1}]
    if twist == "infeasible":
        found.constraints += [{**place, "lower": height + 50.0}]
    if twist == "unbounded":
        load = _load(net, "z", "all")
        del load.given["lower"], load.given["upper"]
        load.lower, load.upper = -np.inf, np.inf
        found.variables, found.goals, found.constraints = [load], [{**place, "weight": 1.0}], []
    if twist == "scaled":
        for goal in found.goals:
            goal["weight"] *= float(10 ** rng.uniform(-6, 6))
    return found
