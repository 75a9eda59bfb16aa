"""Hanging cables that share nothing with hookean: catenaries and chains by statics, and curves cut into equal arcs.

A chain of n elastic links between A and B carries the weight p on each joint. Its tensions have one part H across
gravity, and parts V, V + p, V + 2p ... along it; each link is rest + T / k long and lies along its tension. H and V are
those for which the links lead from A to B. No energy, no iteration over particles. Only numpy and scipy.
"""

from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, root


def parameter(span, length, rise=0.0):
    """The parameter a of a catenary y = a cosh(x / a): sqrt(L^2 - rise^2) = 2a sinh(span / 2a), by bisection."""
    wanted = np.sqrt(length**2 - rise**2) / span
    return 0.5 * span / brentq(lambda u: np.sinh(u) / u - wanted, 1e-9, 300.0, xtol=1e-15, rtol=1e-15)


def heights_at_ends(span, length, rise=0.0):
    """Heights of the catenary's ends over its directrix: times the weight per length, the tensions there.

    With x0 where the curve starts: rise / length = tanh((x0 + span / 2) / a).
    """
    a = parameter(span, length, rise)
    start = a * np.arctanh(rise / length) - 0.5 * span
    return a * np.cosh(start / a), a * np.cosh((start + span) / a)


def catenary(start, end, length, count, gravity=(0, 0, -1)):
    """Points (count + 1, 3) at equal arc lengths of the catenary from start to end."""
    across, up, span, rise = plane(start, end, gravity)
    a = parameter(span, length, rise)
    first = np.arctanh(rise / length) - 0.5 * span / a
    t = np.arcsinh(np.sinh(first) + np.arange(count + 1) * length / count / a)
    return start + a * np.outer(t - first, across) + a * np.outer(np.cosh(t) - np.cosh(first), up)


def chain(start, end, rest, stiffness, weight, gravity=(0, 0, -1)):
    """Joints (n + 1, 3) of a chain with links of rest lengths (n,), `weight` on each inner joint; and tensions (n,)."""
    across, up, span, rise = plane(start, end, gravity)
    rest = np.asarray(rest, float)
    steps = weight * np.arange(len(rest))

    def links(unknown):
        tension = np.hypot(unknown[0], unknown[1] + steps)
        return (rest / tension + 1.0 / stiffness)[:, None] * np.stack([0.0 * steps + unknown[0], unknown[1] + steps], 1)

    # begin with a catenary of this length, or a slightly longer one where the chain has to stretch
    length = max(rest.sum(), 1.05 * np.hypot(span, rise))
    a, per_length = parameter(span, length, rise), weight * len(rest) / length
    guess = per_length * a * np.array([1.0, np.sinh(np.arctanh(rise / length) - 0.5 * span / a)])
    found = root(lambda u: links(u).sum(axis=0) - (span, rise), guess, tol=1e-14).x
    for _ in range(3):  # the last digits, by Newton's method with differences
        off = links(found).sum(axis=0) - (span, rise)
        h = 1e-6 * np.linalg.norm(found)
        slopes = [(links(found + d) - links(found - d)).sum(axis=0) / (2 * h) for d in h * np.eye(2)]
        found = found - np.linalg.solve(np.stack(slopes, axis=1), off)
    assert np.abs(links(found).sum(axis=0) - (span, rise)).max() < 1e-12 * rest.sum()
    joints = np.vstack([[0.0, 0.0], np.cumsum(links(found), axis=0)])
    return start + joints @ np.array([across, up]), np.hypot(found[0], found[1] + steps)


def plane(start, end, gravity):
    """Directions across gravity and up, and the distances of the ends along them."""
    up = -np.asarray(gravity, float) / np.linalg.norm(gravity)
    chord = np.asarray(end, float) - start
    rise = float(chord @ up)
    across = chord - rise * up
    span = float(np.linalg.norm(across))
    return across / span, up, span, rise


def divided(curve, count):
    """Points (count + 1, 3) that cut a rhino3dm NURBS curve into arcs of equal length.

    Gauss-Legendre of 64 points over each knot span, and bisection for the parameters.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    knots = sorted({min(max(k, curve.Domain.T0), curve.Domain.T1) for k in curve.Knots})

    def length(a, b):
        t = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        return 0.5 * (b - a) * sum(w * np.linalg.norm(_derivative(curve, v)) for w, v in zip(weights, t, strict=True))

    upto = np.concatenate([[0.0], np.cumsum([length(a, b) for a, b in pairwise(knots)])])
    at = [knots[0]]
    for target in upto[-1] * np.arange(1, count) / count:
        i = int(np.clip(np.searchsorted(upto, target) - 1, 0, len(knots) - 2))
        a, b, missing = knots[i], knots[i + 1], target - upto[i]
        at.append(brentq(lambda t, a=a, missing=missing: length(a, t) - missing, a, b, xtol=1e-13))
    return np.array([_xyz(curve.PointAt(t)) for t in [*at, knots[-1]]])


def _derivative(curve, t):
    return _xyz(curve.DerivativeAt(float(t), 1)[1])


def _xyz(p):
    return np.array([p.X, p.Y, p.Z])


def curves(path):
    """Curves of a .3dm file by the name of their layer."""
    import rhino3dm

    model = rhino3dm.File3dm.Read(str(path))
    found = {}
    for item in model.Objects:
        found.setdefault(model.Layers[item.Attributes.LayerIndex].Name, []).append(item.Geometry)
    return found
