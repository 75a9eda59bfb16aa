"""Numbers of the falling sphere without hookean: formulas, an eigenvalue problem, and a plate on the mesh's own lines.

The simulation shares the parameters and the physics with hookean, not the methods: bending is that of a plate divided
along the lines of the mesh (each quad a piece, hinges D l / h on its sides, twist between its diagonals), motion is
stepped by the semi-implicit Euler scheme, the floor is a stop with rebound and sliding friction. Prints JSON by the
names of expected.json.
"""

import json
from pathlib import Path

import numpy as np
import rhino3dm
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh

RADIUS, DROP, AROUND, ALONG = 5.0, 5.0, 20, 12
STIFFNESS, DAMPING, BENDING = 5000.0, 10.0, 500.0  # N/m, N s/m, N m
MASS, DRAG, GRAVITY = 1.0, 1.0, 9.81  # kg, N s/m, m/s2
RESTITUTION, FRICTION, SECONDS = 0.7, 0.5, 8.0  # -, -, s


def drawing():
    """Vertices (n, 3) and faces (m, 4) of the mesh in model.3dm."""
    model = rhino3dm.File3dm.Read(str(Path(__file__).parent / "model.3dm"))
    mesh = next(o.Geometry for o in model.Objects if isinstance(o.Geometry, rhino3dm.Mesh))
    points = [[p.X, p.Y, p.Z] for p in (mesh.Vertices[i] for i in range(len(mesh.Vertices)))]
    return np.array(points), np.array([mesh.Faces[i] for i in range(mesh.Faces.Count)])


def lines(faces):
    """Edges and diagonals, each once, and how many of those drawn were drawn twice."""
    edges = {tuple(sorted((f[i], f[(i + 1) % 4]))) for f in faces for i in range(4)} - {(p, p) for p in faces.ravel()}
    crossed = [tuple(sorted(pair)) for a, b, c, d in faces for pair in ((a, c), (b, d))]
    once = sorted(edges | set(crossed))
    return np.array(once), len(edges) + len(crossed) - len(once)


def critical_step(x, pairs):
    """(2 / omega) (sqrt(1 + zeta^2) - zeta) of springs that are unstrained, from the largest eigenvalue of B^T B, B the
    rate of each length by the positions."""
    unit = x[pairs[:, 1]] - x[pairs[:, 0]]
    unit /= np.linalg.norm(unit, axis=1)[:, None]
    rows = np.repeat(np.arange(len(pairs)), 6)
    columns = (3 * pairs[:, :, None] + np.arange(3)).reshape(len(pairs), 6).ravel()
    b = sparse.csr_matrix((np.hstack([-unit, unit]).ravel(), (rows, columns)), shape=(len(pairs), x.size))
    largest = eigsh(b.T @ b, k=1, which="LA", v0=np.cos(np.arange(x.size)), return_eigenvectors=False, tol=1e-12)[0]
    omega = np.sqrt(STIFFNESS / MASS * largest)
    zeta = (DAMPING * largest + DRAG) / MASS / (2.0 * omega)
    return 2.0 / omega * (np.sqrt(1.0 + zeta**2) - zeta)


def fallen(t):
    """Fall from rest under weight and drag after t."""
    late = MASS / DRAG
    return GRAVITY * late * (t - late * (1.0 - np.exp(-t / late)))


def volume_as_drawn():
    """Frustums between regular polygons of AROUND corners on the parallels: h (A + B + sqrt(A B)) / 3."""
    angles = np.pi * np.arange(ALONG + 1) / ALONG
    area = 0.5 * AROUND * (RADIUS * np.sin(angles)) ** 2 * np.sin(2.0 * np.pi / AROUND)
    height = -np.diff(RADIUS * np.cos(angles))
    return (height * (area[1:] + area[:-1] + np.sqrt(area[1:] * area[:-1])) / 3.0).sum()


def volume(x, faces):
    """By the divergence theorem, quads as the mean of their two cuts."""
    a, b, c, d = (x[faces[:, i]] for i in range(4))
    six = [np.einsum("ij,ij->i", p, np.cross(q, r)).sum() for p, q, r in ((a, b, c), (a, c, d), (a, b, d), (b, c, d))]
    return sum(six) / 12.0


def hinges(x, faces):
    """Rows of weights (h, n) for start, end, tip, tip of each hinge, and their stiffnesses.

    The two faces at an edge turn about it by the change of curvature times the distance h of their middles: S = D l / h
    (a plate in strips). A quad a x b that twists by k folds by k sqrt(a^2 + b^2) about either diagonal and costs
    D k^2 a b: S = 2 D a b / (a^2 + b^2), half of it for each diagonal.
    """
    quads = np.array([len(set(f)) == 4 for f in faces])
    sides = {}
    for number, face in enumerate(faces):
        ring = face if quads[number] else face[:3]
        for p, q in zip(ring, np.roll(ring, -1), strict=True):
            sides.setdefault((min(p, q), max(p, q)), []).append([r for r in ring if r not in (p, q)])
    corner = np.eye(len(x))
    rows, strengths = [], []
    for (p, q), (one, other) in sides.items():
        e = (x[q] - x[p]) / np.linalg.norm(x[q] - x[p])
        tips = [corner[far].mean(axis=0) for far in (one, other)]
        high = [np.linalg.norm(np.cross(tip @ x - x[p], e)) for tip in tips]
        # the middle of a quad lies at half its height, that of a triangle at a third
        middles = sum(h / (4 - len(far)) for h, far in zip(high, (one, other), strict=True))
        rows.append([corner[p], corner[q], *tips])
        strengths.append(BENDING * np.linalg.norm(x[q] - x[p]) / middles)
    for a, b, c, d in faces[quads]:
        u = 0.5 * np.linalg.norm(x[b] - x[a] + x[c] - x[d])
        v = 0.5 * np.linalg.norm(x[d] - x[a] + x[c] - x[b])
        for p, q, r, s in ((a, c, d, b), (b, d, a, c)):
            rows.append([corner[p], corner[q], corner[r], corner[s]])
            strengths.append(BENDING * u * v / (u * u + v * v))
    return np.array(rows), np.array(strengths)


def folds(x, rows, strengths, rest):
    """Angles of hinges, and the forces (n, 3) that turn them back to `rest`."""
    a, b, c, d = (m @ x for m in rows)
    e, p, q = b - a, c - a, d - a
    size = np.linalg.norm(e, axis=1)
    m, n = np.cross(e, p), np.cross(q, e)
    angle = np.arctan2(size * np.einsum("ij,ij->i", n, p), np.einsum("ij,ij->i", m, n))
    if rest is None:
        return angle, None
    turn = (angle - rest + np.pi) % (2.0 * np.pi) - np.pi
    pull = (-strengths * turn * size)[:, None]
    at_c = pull * m / np.einsum("ij,ij->i", m, m)[:, None]
    at_d = pull * n / np.einsum("ij,ij->i", n, n)[:, None]
    foot_c, foot_d = ((np.einsum("ij,ij->i", r, e) / size**2)[:, None] for r in (p, q))
    at_b = -foot_c * at_c - foot_d * at_d
    shares = (-at_c - at_d - at_b, at_b, at_c, at_d)
    return angle, sum(m.T @ f for m, f in zip(rows, shares, strict=True))


def fall(start, faces, pairs, bends, dt, seconds):
    """Height and volume kept [%] after so many seconds."""
    x, v = start.copy(), np.zeros_like(start)
    ends = np.arange(len(pairs))
    one = np.ones(len(pairs))
    joins = sparse.csr_matrix(
        (np.hstack([-one, one]), (np.hstack([ends, ends]), pairs.T.ravel())), shape=(len(pairs), len(x))
    )
    back = joins.T.tocsr()
    length = np.linalg.norm(joins @ x, axis=1)
    if bends:
        weights, strengths = hinges(x, faces)
        rows = [sparse.csr_matrix(weights[:, i]) for i in range(4)]
        rest, _ = folds(x, rows, strengths, None)
    for _ in range(round(seconds / dt)):
        d = joins @ x
        now = np.linalg.norm(d, axis=1)
        rate = np.einsum("ij,ij->i", joins @ v, d) / now
        f = -back @ (((STIFFNESS * (now - length) + DAMPING * rate) / now)[:, None] * d)
        if bends:
            f += folds(x, rows, strengths, rest)[1]
        f -= DRAG * v
        f[:, 2] -= MASS * GRAVITY
        v += dt / MASS * f
        x += dt * v
        stop(x, v)
    return 100.0 * np.ptp(x[:, 2]) / np.ptp(start[:, 2]), 100.0 * volume(x, faces) / volume(start, faces)


def stop(x, v):
    """The floor: what is below goes back onto it and rebounds, what slides is slowed by friction."""
    below = (x[:, 2] < 0.0) & (v[:, 2] < 0.0)
    x[x[:, 2] < 0.0, 2] = 0.0
    kick = -(1.0 + RESTITUTION) * v[below, 2]
    slip = np.linalg.norm(v[below, :2], axis=1)
    v[below, :2] *= np.maximum(1.0 - FRICTION * kick / np.maximum(slip, 1e-12), 0.0)[:, None]
    v[below, 2] += kick


def main():
    x, faces = drawing()
    pairs, twice = lines(faces)
    bent = fall(x, faces, pairs, True, 0.003, SECONDS)
    loose = np.max([fall(x, faces, pairs, False, dt, SECONDS) for dt in (0.002, 0.003, 0.004)], axis=0)
    numbers = {
        "springs": len(pairs),
        "duplicate lines": twice,
        "volume as drawn": volume_as_drawn(),
        "fallen after 1 s": fallen(1.0),
        "critical step, springs alone": critical_step(x, pairs),
        "first contact": brentq(lambda t: fallen(t) - DROP, 0.1, 10.0, xtol=1e-12),
        "height kept, springs alone": loose[0],
        "volume kept, springs alone": loose[1],
        "height kept, with Shell": bent[0],
        "volume kept, with Shell": bent[1],
    }
    print(json.dumps(numbers))


if __name__ == "__main__":
    main()
