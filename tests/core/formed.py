"""Random scenes whose form is found and then frozen, seeded: nets of force densities, nets of rest factors with edge
cables of constant tension, cable nets of springs, bent gridshells; films between rims, with yarns, under pressure, with
edge cables, between rings; shells."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize import grid, naked_edges, naked_vertices

from .film_meshes import cut, tube
from .random_nets import lattice, rim

Numbers = np.random.Generator
Spec = dict[str, Any]


def formed(seed: int) -> Spec:
    """The scene of a seed, as `Scene.read` takes it; its load case is a snow load."""
    rng = np.random.default_rng([21, seed])
    return FAMILIES[seed % len(FAMILIES)](rng)


def frame(rng: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A net whose rim is on a saddle, and the numbers of its points."""
    x, pairs, number = lattice(rng, int(rng.integers(30, 150)))
    x[:, 2] = rng.uniform(0.02, 0.2) * np.prod(x[:, :2] - x[:, :2].mean(axis=0), axis=1)
    inner = ~np.isin(np.arange(len(x)), rim(number))
    x[inner] += 0.2 * rng.normal(size=(inner.sum(), 3))
    return x, pairs, number


def cased(spec: Spec, rng: Numbers, count: int) -> Spec:
    """With a snow load, which is in a load case."""
    snow = {"kind": "unary", "name": "snow", "particles": np.arange(count), "vector": [0, 0, -rng.uniform(0.1, 1.0)]}
    spec["forces"] = [*spec["forces"], snow]
    spec["load_cases"] = {"snow": {"forces": ["snow"]}}
    return spec


def densities(rng: Numbers) -> Spec:
    """A net of force densities under its weight."""
    x, pairs, number = frame(rng)
    net = {"kind": "springs", "name": "net", "particles": pairs, "rest_length": 0.0}
    net["stiffness"] = 10.0 ** rng.uniform(0.0, 1.5, len(pairs))
    weight = {"kind": "self_weight", "total": rng.uniform(0.0, 20.0)}
    stages = {"freeze": {"net": {"axial_stiffness": 10.0 ** rng.uniform(2, 5)}}}
    return cased({"particles": x, "forces": [net, weight], "anchors": [{"particles": rim(number)}], "stages": stages},
                 rng, len(x))  # fmt: skip


def membrane(rng: Numbers) -> Spec:
    """A net of rest factor 0 between edge cables of constant tension, held at its corners."""
    x, pairs, number = frame(rng)
    edge = np.isin(pairs, rim(number)).all(axis=1)
    inner = {"kind": "springs", "name": "cloth", "particles": pairs[~edge], "rest_factor": 0.0, "stiffness": 10.0}
    cable = {"kind": "constant_tension", "name": "edge", "particles": pairs[edge], "tension": rng.uniform(40, 100)}
    held = number[[0, 0, -1, -1], [0, -1, 0, -1]]
    ea = {"cloth": {"axial_stiffness": 500.0}, "edge": {"axial_stiffness": 1e4, "tension_only": True}}
    scene = {"particles": x, "forces": [inner, cable], "anchors": [{"particles": held}], "stages": {"freeze": ea}}
    return cased(scene, rng, len(x))


def cable_net(rng: Numbers) -> Spec:
    """A net of springs that are shorter than drawn, with a pressure-like load upwards."""
    x, pairs, number = frame(rng)
    net = {"kind": "springs", "name": "net", "particles": pairs, "stiffness": 10.0 ** rng.uniform(1, 4)}
    net["rest_factor"] = rng.uniform(0.5, 0.95, len(pairs))
    lift = {"kind": "unary", "name": "lift", "particles": np.arange(len(x)), "vector": [0, 0, rng.uniform(0, 0.5)]}
    return cased({"particles": x, "forces": [net, lift], "anchors": [{"particles": rim(number)}]}, rng, len(x))


def gridshell(rng: Numbers) -> Spec:
    """Rods pushed together at their ends until they stand up, on a square grid."""
    n = int(rng.integers(5, 9))
    number = np.arange(n * n).reshape(n, n)
    x = np.zeros((n * n, 3))
    x[:, :2] = np.stack(np.divmod(np.arange(n * n), n), axis=1)
    x[:, 2] = 0.3 * np.sin(np.pi * x[:, 0] / (n - 1)) * np.sin(np.pi * x[:, 1] / (n - 1))
    lines = [*number, *number.T]
    pairs = np.concatenate([np.column_stack([a[:-1], a[1:]]) for a in lines])
    corners = np.concatenate([np.column_stack([a[:-2], a[1:-1], a[2:]]) for a in lines])
    held = rim(number)
    targets = x[held] * [1, 1, 0]
    targets[:, :2] = (targets[:, :2] - (n - 1) / 2) * rng.uniform(0.92, 0.98) + (n - 1) / 2
    rods = {"kind": "springs", "name": "rods", "particles": pairs, "stiffness": 1e3}
    bend = {"kind": "bend", "particles": corners, "stiffness": rng.uniform(5.0, 50.0), "rest_angle": 0.0}
    anchors = [{"particles": held, "targets": targets}]
    return cased({"particles": x, "forces": [rods, bend], "anchors": anchors}, rng, len(x))


def skin(rng: Numbers) -> Spec:
    """A mesh over a rectangle, of quads or triangles, its vertices on a slanting saddle."""
    n, m = rng.integers(5, 10, 2)
    mesh = grid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, m + 1) * rng.uniform(0.6, 1.5))
    x, (a, b, c) = np.array(mesh.vertices), rng.uniform(-0.5, 0.5, 3)
    x[:, 2] = a * x[:, 0] * x[:, 1] + b * x[:, 0] ** 2 + c * x[:, 1]
    faces = cut(mesh.faces, "quads" if rng.random() < 0.5 else "triangles")
    return {"particles": x, "meshes": {"skin": {"vertices": x, "faces": faces}}, "stages": {"films": {"film": {
        "warp_stiffness": 10.0 ** rng.uniform(2, 4), "poisson": rng.uniform(0.0, 0.4)}}}}  # fmt: skip


def film(rng: Numbers) -> Spec:
    """A film on a rim, perhaps with yarns."""
    scene = skin(rng)
    woven = dict(zip(("warp", "weft"), rng.uniform(0.5, 3.0, 2), strict=True)) if rng.random() < 0.5 else {}
    forces = [{"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": rng.uniform(1, 5), **woven}]
    anchors = [{"particles": naked_vertices(tuple(scene["meshes"]["skin"].values()))}]
    return cased({**scene, "forces": forces, "anchors": anchors}, rng, len(scene["particles"]))


def bubble(rng: Numbers) -> Spec:
    """A film on a rim under pressure, which stays with the shape."""
    spec = film(rng)
    lift = {"kind": "pressure", "name": "lift", "mesh": "skin", "pressure": rng.uniform(-0.5, 0.5)}
    return {**spec, "forces": [spec["forces"][0], lift, *spec["forces"][1:]]}


def tent(rng: Numbers) -> Spec:
    """A film between edge cables of constant tension, held at its corners."""
    scene = skin(rng)
    mesh = tuple(scene["meshes"]["skin"].values())
    x = scene["particles"]
    held = [int(np.argmin((x[:, :2] * signs).sum(axis=1))) for signs in ([1, 1], [1, -1], [-1, 1], [-1, -1])]
    tension = rng.uniform(1, 5)
    forces = [{"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": tension}]
    cables = {"kind": "constant_tension", "name": "edge", "particles": naked_edges(mesh)}
    forces.append({**cables, "tension": tension * rng.uniform(8.0, 15.0)})
    stages = {**scene["stages"], "freeze": {"edge": {"axial_stiffness": 1e4}}}
    return cased({**scene, "forces": forces, "stages": stages, "anchors": [{"particles": held}]}, rng, len(x))


def catenoid(rng: Numbers) -> Spec:
    """A film between two rings, on quads or triangles."""
    kind = "quads" if rng.random() < 0.5 else "triangles"
    x, faces, rings = tube(int(rng.integers(8, 16)), int(rng.integers(3, 7)), rng.uniform(0.2, 0.5), kind)
    forces = [{"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": rng.uniform(1, 5)}]
    return cased({"particles": x, "meshes": {"skin": {"vertices": x, "faces": faces}}, "forces": forces,
                  "anchors": [{"particles": rings}], "stages": {"films": {"film": {"warp_stiffness": 500.0}}}},
                 rng, len(x))  # fmt: skip


def plate(rng: Numbers) -> Spec:
    """A shell that bends with springs along its edges, between rims pushed towards each other; its stress-free shape
    stays the drawn one."""
    scene = skin(rng)
    mesh, x = tuple(scene["meshes"]["skin"].values()), scene["particles"]
    held = np.asarray(naked_vertices(mesh))
    forces = [{"kind": "springs", "name": "net", "mesh": "skin", "stiffness": 1e3}]
    forces.append({"kind": "shell", "mesh": "skin", "strength": rng.uniform(1.0, 20.0), "poisson": 0.3})
    anchors = [{"particles": held, "targets": x[held] * rng.uniform(0.96, 0.99)}]
    return cased({"particles": x, "meshes": scene["meshes"], "forces": forces, "anchors": anchors}, rng, len(x))


FAMILIES = (densities, membrane, cable_net, gridshell, film, bubble, tent, catenoid, plate)
