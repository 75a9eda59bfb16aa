"""Numbers of figure 9.32 without hookean: the net of the drawn surface, pulled to the NURBS curves themselves.

Newton's method on E(x, t) = sum k (l - l0)^2 / 2 + sum S |C(t) - x|^2 / 2 over the particles x and, for each pull, the
parameter t of its foot on its curve C. The least over t is the closest point; no curve becomes a polyline here.
Prints the numbers as JSON by the names of expected.json.
"""

import json
from pathlib import Path

import numpy as np
import rhino3dm
import scipy.sparse as sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import spsolve

U, V = 60, 20
STIFFNESS, FACTOR, STRENGTH = 4.0, 0.5, 2000.0


def drawn(path):
    """Points of the surface at even parameters, (U + 1, V + 1, 3), and the curves of every layer as splines."""
    file = rhino3dm.File3dm.Read(str(path))
    names = [layer.FullPath for layer in file.Layers]
    curves = {}
    for item in file.Objects:
        shape = item.Geometry
        if isinstance(shape, rhino3dm.NurbsSurface):
            (u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (shape.Domain(0), shape.Domain(1)))
            at = [shape.PointAt(u, v) for u in np.linspace(u0, u1, U + 1) for v in np.linspace(v0, v1, V + 1)]
        else:
            knots = [shape.Knots[i] for i in range(len(shape.Knots))]
            control = [(p.X, p.Y, p.Z) for p in (shape.Points[i] for i in range(len(shape.Points)))]
            spline = BSpline([knots[0], *knots, knots[-1]], np.array(control), shape.Degree, extrapolate=False)
            curves.setdefault(names[item.Attributes.LayerIndex], []).append(spline)
    return np.array([(p.X, p.Y, p.Z) for p in at]), curves


def pulls(x, beams, arcs):
    """Of each pull: particle, curve and a parameter near its foot. On a beam lie the particles of one edge of the net,
    on the i-th inner arc those of row 6 i."""
    number = np.arange(len(x)).reshape(U + 1, V + 1)
    rows = [number[:, 0], number[:, -1], *(number[6 * i] for i in range(1, 10))]
    found = []
    for curve in (*beams, *arcs):
        steps = np.linspace(curve.t[0], curve.t[-1], 4001)
        row = min(rows, key=lambda r: np.abs(np.linalg.norm(x[r][:, None] - curve(steps[::50]), axis=2).min(1)).max())
        at = steps[np.linalg.norm(x[row][:, None] - curve(steps), axis=2).argmin(axis=1)]
        found += [(particle, curve, t) for particle, t in zip(row, at, strict=True)]
    assert len({id(c) for _, c, _ in found}) == 11 and len(found) == 2 * (U + 1) + 9 * (V + 1)
    return found


def derivatives(x, t, pairs, rest, particles, curves):
    """Energy, gradient (3 n + p,) and Hessian in all particles and feet."""
    n, p = 3 * len(x), len(t)
    d = x[pairs[:, 1]] - x[pairs[:, 0]]
    length = np.linalg.norm(d, axis=1)
    e, force = d / length[:, None], STIFFNESS * (length - rest)
    feet, slope, bend = (np.array([c(s, nu) for c, s in zip(curves, t, strict=True)]) for nu in (0, 1, 2))
    away = feet - x[particles]
    energy = 0.5 * STIFFNESS * ((length - rest) ** 2).sum() + 0.5 * STRENGTH * (away**2).sum()
    gradient = np.zeros((len(x), 3))
    np.add.at(gradient, pairs[:, 0], -force[:, None] * e)
    np.add.at(gradient, pairs[:, 1], force[:, None] * e)
    np.add.at(gradient, particles, -STRENGTH * away)
    along = STRENGTH * (away * slope).sum(axis=1)
    outer = e[:, :, None] * e[:, None, :]
    block = STIFFNESS * outer + (force / length)[:, None, None] * (np.eye(3) - outer)
    entries = [(pairs[:, a], pairs[:, b], s * block) for a, b, s in ((0, 0, 1), (1, 1, 1), (0, 1, -1), (1, 0, -1))]
    entries.append((particles, particles, np.broadcast_to(STRENGTH * np.eye(3), (p, 3, 3))))
    axis = np.arange(3)
    rows = [np.broadcast_to(3 * a[:, None, None] + axis[:, None], b.shape).ravel() for a, _, b in entries]
    columns = [np.broadcast_to(3 * c[:, None, None] + axis, b.shape).ravel() for _, c, b in entries]
    values = [b.ravel() for _, _, b in entries]
    both, foot = (3 * particles[:, None] + axis).ravel(), np.repeat(n + np.arange(p), 3)
    rows += [both, foot, n + np.arange(p)]
    columns += [foot, both, n + np.arange(p)]
    mixed = (-STRENGTH * slope).ravel()
    values += [mixed, mixed, STRENGTH * ((slope**2).sum(axis=1) + (away * bend).sum(axis=1))]
    ij = (np.concatenate(rows), np.concatenate(columns))
    hessian = sparse.csr_matrix((np.concatenate(values), ij), shape=(n + p, n + p))
    return energy, np.concatenate([gradient.ravel(), along]), hessian


def equilibrium(x, pairs, held, pulled):
    """Particles and feet where the energy is least."""
    rest = FACTOR * np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    particles, curves = np.array([p for p, _, _ in pulled]), [c for _, c, _ in pulled]
    t, x = np.array([t for _, _, t in pulled]), x.copy()
    low, high = np.array([c.t[0] for c in curves]), np.array([c.t[-1] for c in curves])
    fixed = np.concatenate(
        [(3 * held[:, None] + np.arange(3)).ravel(), 3 * len(x) + np.flatnonzero(np.isin(particles, held))]
    )
    free = np.setdiff1d(np.arange(3 * len(x) + len(t)), fixed)
    push = 1e-4
    for _ in range(500):
        energy, gradient, hessian = derivatives(x, t, pairs, rest, particles, curves)
        if np.abs(gradient[free]).max() < 1e-9:
            assert (t >= low).all() and (t <= high).all()
            return x, t, particles, curves
        step = np.zeros(len(gradient))
        damped = hessian[free][:, free] + push * sparse.diags(hessian.diagonal()[free])
        step[free] = spsolve(damped.tocsc(), -gradient[free])
        to, at = x + step[: x.size].reshape(-1, 3), np.clip(t + step[x.size :], low, high)
        if derivatives(to, at, pairs, rest, particles, curves)[0] <= energy * (1.0 + 1e-14):
            x, t, push = to, at, push / 10 if push > 1e-12 else 0.0
        else:
            push = max(10 * push, 1e-10)
    raise RuntimeError("no equilibrium found")


def area(x):
    """Sum over the quads, each the mean of its two cuts into triangles [m2]."""
    a, b, c, d = x[:-1, :-1], x[1:, :-1], x[1:, 1:], x[:-1, 1:]
    cuts = [(b - a, c - a), (c - a, d - a), (b - a, d - a), (c - b, d - b)]
    return sum(0.25 * np.linalg.norm(np.cross(u, v), axis=2).sum() for u, v in cuts)


def angle_excess(x):
    """At the particles inside: sum of the angles of the four quads less 2 pi; above 0 the net is a saddle."""
    middle = x[1:-1, 1:-1]
    around = [x[2:, 1:-1], x[1:-1, 2:], x[:-2, 1:-1], x[1:-1, :-2]]
    arms = [(p - middle) / np.linalg.norm(p - middle, axis=2)[..., None] for p in around]
    return sum(np.arccos((arms[i] * arms[(i + 1) % 4]).sum(axis=2)) for i in range(4)) - 2.0 * np.pi


def main():
    start, curves = drawn(Path(__file__).parent / "model.3dm")
    number = np.arange(len(start)).reshape(U + 1, V + 1)
    across = np.stack([number[:, :-1], number[:, 1:]], axis=2).reshape(-1, 2)
    along = np.stack([number[:-1], number[1:]], axis=2).reshape(-1, 2)
    held = np.concatenate([number[0], number[-1]])
    pulled = pulls(start, curves["beams"], curves["arcs::inner"])
    x, t, particles, to = equilibrium(start, np.concatenate([across, along]), held, pulled)
    force = {}
    for name, pairs in (("across", across), ("along", along)):
        before, after = (np.linalg.norm(y[pairs[:, 1]] - y[pairs[:, 0]], axis=1) for y in (start, x))
        force[name] = STIFFNESS * (after - FACTOR * before)
    feet = np.array([c(s) for c, s in zip(to, t, strict=True)])
    between = np.arange(1, U) % 6 != 0
    saddle = (angle_excess(x.reshape(U + 1, V + 1, 3))[between] > 0).mean()
    edge = np.concatenate([number[:, 0], number[:, -1]])
    print(
        json.dumps(
            {
                "area of the surface drawn": area(start.reshape(U + 1, V + 1, 3)),
                "area": area(x.reshape(U + 1, V + 1, 3)),
                "smallest force across": force["across"].min(),
                "largest force across": force["across"].max(),
                "smallest force along": force["along"].min(),
                "largest force along": force["along"].max(),
                "slack springs": int(sum((f <= 0).sum() for f in force.values())),
                "farthest from its beam or arc": 1000 * np.linalg.norm(feet - x[particles], axis=1).max(),
                "farthest from where it was drawn": np.linalg.norm(x - start, axis=1).max(),
                "farthest slid along a beam": np.linalg.norm((x - start)[edge], axis=1).max(),
                "saddle-shaped between the arcs": 100 * saddle,
                "saddle-shaped as drawn": 100 * (angle_excess(start.reshape(U + 1, V + 1, 3))[between] > 0).mean(),
            }
        )
    )


if __name__ == "__main__":
    main()
