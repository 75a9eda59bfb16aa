"""An answer to a random problem checked by code of its own: values, limits, minimum of first order, and that what is
said not to exist is not found."""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares, minimize, nnls

from hookean.designing.answer import Design

from .own_nets import Net, Quantity, measured
from .random_problems import Case, unit_of

STEP = 1e-5  # of an unknown's size, of differences of second order: 1e-10, and rounding by 1e-11
SAME = 1e-6  # part by which values of both programs may differ
SLACK = 1e-6  # part of the size of a constraint's values, by which it may be missed (docs/design.md)
FLAT = 1e-4  # part of the objective: slopes below are those of a minimum
BETTER = 1e-6  # part of the objective: a fall that counts


def whole(quantity: Quantity) -> Quantity:
    """The values that a quantity has differences of."""
    return {**quantity, "equal": False, "smooth": False}


class Check:
    """A problem at its answer."""

    def __init__(self, case: Case, found: Design) -> None:
        self.case, self.found = case, found
        self.u = np.concatenate([np.ravel(v["value"]) for v in found.variables]).astype(float)
        self.net, self.x = case.at(self.u, np.array(found.result.particles))
        self.lower, self.upper = case.bounds
        wide, size = self.upper - self.lower, np.abs(case.start).max() + np.abs(self.u)
        size = np.where(size > 0.0, size, np.where(np.isfinite(wide), wide, 1.0))
        self.scale = np.minimum(np.where(wide > 0.0, wide, size), np.maximum(size, 1e-3 * size.max()))
        self.first = self.objective(case.start)
        self.sizes = [self._size(q) for q in case.constraints]
        self.first_missed = float(np.abs(self.missed(*case.at(case.start, self.x))).max(initial=0.0))

    def _size(self, q: Quantity) -> float:
        own = np.abs(measured(*self.case.at(self.case.start, self.x), whole(q))).max()
        limits = [abs(q[side]) for side in ("lower", "upper") if side in q]
        return float(
            max(
                own,
                *limits,
                np.linalg.norm(np.ptp(self.net.x, axis=0)) if unit_of(self.net, q) == self.net.units[0] else 0,
            )
        )

    def objective(self, u: np.ndarray) -> float:
        return self.of_goals(*self.case.at(np.clip(u, *self.case.bounds), self.x))

    def of_goals(self, net: Net, x: np.ndarray) -> float:
        total = 0.0
        for goal in self.case.goals:
            own = measured(net, x, goal)
            if "target" in goal:
                total += goal["weight"] * float(((own - np.reshape(goal["target"], -1)) ** 2).sum())
            elif "lower" in goal:
                total += goal["weight"] * float(((own - np.clip(own, goal["lower"], goal["upper"])) ** 2).sum())
            else:
                total += goal["weight"] * float(own.sum())
        return total

    def margins(self, net: Net, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far values are within their limits, by size (k,); and which of them are equations (k,)."""
        parts, equal = [np.zeros(0)], [np.zeros(0, bool)]
        for q, size in zip(self.case.constraints, self.sizes, strict=True):
            own, same = measured(net, x, q), q.get("lower") == q.get("upper")
            rows = [own - q["lower"]] if "lower" in q else []
            rows += [q["upper"] - own] if "upper" in q and not same else []
            parts += [row / size for row in rows]
            equal += [np.full(len(row), same) for row in rows]
        return np.concatenate(parts), np.concatenate(equal)

    def missed(self, net: Net, x: np.ndarray) -> np.ndarray:
        own, equal = self.margins(net, x)
        return np.where(equal, own, np.minimum(own, 0.0))

    def both(self, y: np.ndarray) -> tuple[float, np.ndarray]:
        net, x = self.case.at(np.clip(y * self.scale, self.lower, self.upper), self.x)
        return self.of_goals(net, x), self.margins(net, x)[0]

    def slopes(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of the objective (u,) and of the margins (k, u), by scaled unknowns, one-sided at bounds."""
        rows, sides = [], []
        for i in range(len(y)):
            ahead, behind = y.copy(), y.copy()
            ahead[i] = min(y[i] + STEP, self.upper[i] / self.scale[i])
            behind[i] = max(y[i] - STEP, self.lower[i] / self.scale[i])
            (f, c), (g, d) = self.both(ahead), self.both(behind)
            rows.append((f - g) / (ahead[i] - behind[i]))
            sides.append((c - d) / (ahead[i] - behind[i]))
        return np.array(rows), np.array(sides).T.reshape(-1, len(y))

    def left(self) -> float:
        """What no bound and no limit holds of the objective's slope, by its size (Karush, Kuhn and Tucker)."""
        y = self.u / self.scale
        slope, rows = self.slopes(y)
        margin, equal = self.margins(self.net, self.x)
        near = margin <= 1e-5
        low, high = (self.u - self.lower <= 1e-7 * self.scale), (self.upper - self.u <= 1e-7 * self.scale)
        pushes = np.vstack([rows[near], -rows[equal], np.eye(len(y))[low], -np.eye(len(y))[high]])
        size = np.linalg.norm(pushes, axis=1)
        pushes = pushes[size > 0] / size[size > 0, None]
        rest = nnls(pushes.T, slope)[1] if len(pushes) else np.linalg.norm(slope)
        return float(rest) / self.measure

    @property
    def measure(self) -> float:
        """What objectives are measured by."""
        squares = sum(g["weight"] * float((measured(self.net, self.x, whole(g)) ** 2).sum()) for g in self.case.goals)
        return abs(self.found.objective) + 1e-6 * abs(self.first) + 1e-24 * squares

    def better(self) -> tuple[float, float]:
        """The objective that SciPy finds from the answer with derivatives by differences, and what it misses."""
        equal = self.margins(self.net, self.x)[1]
        kept = [("eq", equal), ("ineq", ~equal)]
        limits = [
            {"type": kind, "fun": lambda y, r=rows: self.both(y)[1][r], "jac": lambda y, r=rows: self.slopes(y)[1][r]}
            for kind, rows in kept
            if rows.any()
        ]
        end = minimize(
            lambda y: self.both(y)[0] / self.measure, self.u / self.scale,
            jac=lambda y: self.slopes(y)[0] / self.measure, method="SLSQP", constraints=limits,
            bounds=list(zip(self.lower / self.scale, self.upper / self.scale, strict=True)),
            options={"maxiter": 40, "ftol": 1e-12},
        )  # fmt: skip
        net, x = self.case.at(np.clip(end.x * self.scale, self.lower, self.upper), self.x)
        return self.of_goals(net, x), float(np.abs(self.missed(net, x)).max(initial=0.0))

    def nearest(self, seed: int) -> float:
        """The least that constraints are missed by, of searches from the answer, the start and beside it."""
        rng, least = np.random.default_rng(seed), np.inf
        wide = self.lower < self.upper
        ends = self.lower[wide] / self.scale[wide], self.upper[wide] / self.scale[wide]

        def missed(z: np.ndarray) -> np.ndarray:
            y = self.u / self.scale
            y[wide] = z
            return self.missed(*self.case.at(np.clip(y * self.scale, self.lower, self.upper), self.x))

        for start in (self.u, self.case.start, self.u * rng.uniform(0.5, 1.5, len(self.u))):
            y = (start / self.scale)[wide]
            inner = 1e-9 * np.minimum(1.0, ends[1] - ends[0])
            y = np.clip(y, ends[0] + inner, ends[1] - inner)
            end = least_squares(missed, y, bounds=ends, max_nfev=25)
            least = min(least, float(np.abs(end.fun).max()))
        return least


def faults(check: Check, seed: int) -> list[str]:
    """What is not true of an answer."""
    case, found = check.case, check.found
    if not (np.isfinite(check.u).all() and np.isfinite(found.result.particles).all() and np.isfinite(found.objective)):
        return ["numbers are not finite"]
    said = _values(check)
    if ((check.u < check.lower) | (check.u > check.upper)).any():
        said.append("beyond the bounds")
    missed = float(np.abs(check.missed(check.net, check.x)).max(initial=0.0))
    if found.status == "converged":
        if missed > 1.01 * SLACK:
            said.append(f"converged and misses {missed:.2g}")
        if (left := check.left()) > FLAT:
            value, off = check.better()
            if off <= SLACK and value < found.objective - BETTER * check.measure:
                said.append(f"converged at {found.objective!r}, and {value!r} is near; {left:.2g} of slope")
    elif found.status == "infeasible":
        if missed <= SLACK:
            said.append("infeasible and misses nothing")
        if (least := check.nearest(seed)) <= 1e-2 * SLACK:
            said.append(f"infeasible, and values that miss {least:.2g} are near")
    elif found.status == "unbounded":
        on = check.objective(case.start + 10.0 * (check.u - case.start))
        if not on < found.objective:
            said.append(f"unbounded, and further on the objective is {on:.4g}")
    elif max(missed, check.first_missed) <= SLACK and found.objective > check.first + BETTER * abs(check.first):
        said.append(f"{found.status} at {found.objective:.6g}, and the start has {check.first:.6g}")
    return said


def _values(check: Check) -> list[str]:
    """Values of goals and constraints, the objective and what is met, against those of the own net at rest."""
    case, found, said = check.case, check.found, []
    moved = float(np.abs(found.result.particles - check.x).max()) / check.case.net.units[0]
    if moved > SAME:
        said.append(f"out of balance: particles move by {moved:.2g}")
    entries = [*zip(case.goals, found.goals, strict=True), *zip(case.constraints, found.constraints, strict=True)]
    for q, entry in entries:
        own = measured(check.net, check.x, q)
        if np.abs(own - np.ravel(entry["value"])).max() > SAME * max(float(np.abs(own).max()), unit_of(check.net, q)):
            said.append(f"{q['kind']} is {entry['value']}, here {own}")
    own_objective = check.of_goals(check.net, check.x)
    if abs(own_objective - found.objective) > SAME * check.measure:
        said.append(f"objective {found.objective!r}, here {own_objective!r}")
    for q, entry, size in zip(case.constraints, found.constraints, check.sizes, strict=True):
        own = measured(check.net, check.x, q)
        off = float(np.abs(own - np.clip(own, q.get("lower", -np.inf), q.get("upper", np.inf))).max()) / size
        if entry["met"] != (off <= SLACK) and abs(off - SLACK) > 1e-3 * SLACK:
            said.append(f"{q['kind']} met {entry['met']}, missed by {off:.2g}")
    return said
