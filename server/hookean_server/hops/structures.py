"""The chapter's larger figures as functions of Hops: chain and net hung and turned over, the ribbon, the bridge's
skin."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.cables import arc
from hookean_server.hops.model import Function, Inputs, Parameter, count, item
from hookean_server.workers.task import Cancelled

Floats = NDArray[np.float64]

PIECES = 2000  # of a curve that particles are pulled to


def _in_kilonewtons(parameter: Parameter) -> Parameter:
    return replace(parameter, description=parameter.description.replace("[N", "[kN"))


_FORCES, _REACTIONS = _in_kilonewtons(scenes.FORCES), _in_kilonewtons(scenes.REACTIONS)
_LARGEST = item("Largest force", "Fm", "Number", "The largest force, tension positive [kN]")
_LEAST = item("Least force", "Fn", "Number", "The smallest force, tension positive [kN]")
_SHAPE = (scenes.MESH, scenes.SPRINGS, _FORCES, _REACTIONS, scenes.SUPPORTS, _LARGEST, _LEAST, scenes.STATUS)
_OVER = item("Upside down", "U", "Boolean", "True: upside down, with every force reversed", False)
_UNITS = {"force": "kN"}
_STANDING = {"allow_unstable": True}  # a thrust line of hinged struts balances, as on a knife's edge


def _net(result: Any, mesh: Mesh, *names: str) -> dict[str, Any]:
    found = scenes.common(result, *names)
    forces = found["Forces"]
    shape = Mesh(result.particles, mesh.faces)
    return {**found, "Mesh": shape, "Largest force": forces.max(), "Least force": forces.min()}


def _chain(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    length, span, links = inputs.one("Arc length"), inputs.one("Span"), inputs.one("Links")
    stiffness, weight = inputs.one("Stiffness"), inputs.one("Weight")
    points = arc(length, span, links) * [1.0, 1.0, -1.0]
    link = length / links
    springs = {"kind": "springs", "name": "chain", "particles": scenes.chain(links), "stiffness": stiffness,
               "rest_length": link}  # fmt: skip
    inner = np.arange(1, links)
    weights = {"kind": "unary", "name": "weight", "particles": inner, "vector": [0.0, 0.0, -weight * link]}
    anchors = [{"particles": [0, links]}]
    units = {"length": inputs.units, **_UNITS}
    scene = {"units": units, "particles": points, "forces": [springs, weights], "anchors": anchors}
    result = scenes.relaxed(inputs, scene, cancelled)
    if inputs.one("Upside down"):
        result = scenes.relaxed(inputs, _over(result, "chain", stiffness, units), cancelled)
    found = scenes.common(result, "chain")
    z = result.particles[:, 2]
    return {
        **found,
        "Height": np.abs(z).max(),
        "Pull": np.abs(found["Reactions"][0][0]),
        "Largest force": found["Forces"].max(),
        "Least force": found["Forces"].min(),
    }


def _over(result: Any, name: str, stiffness: float, units: Any) -> dict[str, Any]:
    """A hanging shape mirrored in the plane z = 0 under the same loads. Each strut is so much longer than its place
    that it pushes as hard as the string pulled: rest length = length + tension / k."""
    strings, weight = result.force(name), result.force("weight")
    struts = {"kind": "springs", "name": name, "particles": strings["particles"], "stiffness": stiffness,
              "rest_length": strings["length"] + strings["force"] / stiffness}  # fmt: skip
    loads = {"kind": "unary", "name": "weight", "particles": weight["particles"][:, 0], "vector": weight["force"]}
    return {
        "units": units,
        "particles": result.particles * [1.0, 1.0, -1.0],
        "forces": [struts, loads],
        "anchors": [{"particles": result.reactions["particles"]}],
        "settings": _STANDING,
    }


def _vault(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import edges

    sides, stiffness = (inputs.one("Length"), inputs.one("Width")), inputs.one("Stiffness")
    along, across = inputs.one("Along"), inputs.one("Across")
    mesh = scenes.grid(np.linspace(0.0, sides[0], along + 1), np.linspace(0.0, sides[1], across + 1))
    pairs = edges(mesh)
    number = np.arange(len(mesh.vertices)).reshape(along + 1, across + 1)
    columns = number[np.ix_([0, along // 2, along], [0, across // 2, across])].ravel()
    springs = {"kind": "springs", "name": "net", "particles": pairs, "stiffness": stiffness,
               "rest_factor": inputs.one("Length factor")}  # fmt: skip
    weight = {"kind": "self_weight", "name": "weight", "particles": pairs, "per_length": inputs.one("Weight")}
    units = {"length": inputs.units, **_UNITS}
    scene = {
        "units": units,
        "particles": mesh.vertices,
        "forces": [springs, weight],
        "anchors": [{"particles": np.unique(columns)}],
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    if inputs.one("Upside down"):
        result = scenes.relaxed(inputs, _over(result, "net", stiffness, units), cancelled)
    found = _net(result, mesh, "net")
    pull = found["Reactions"]
    return {
        **found,
        "Height": np.abs(result.particles[:, 2]).max(),
        "Total weight": pull[:, 2].sum(),
        "Thrust at a corner": np.hypot(*pull[0, :2]),
    }


def _ribbon(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize import mesh_surface
    from hookean.discretize.meshes import naked_vertices
    from hookean.discretize.warpweft import warp_weft

    mesh = mesh_surface(inputs.surface("Surface"), inputs.one("Along"), inputs.one("Across"))
    if len(mesh.faces) > inputs.largest:
        raise InputError("/Along", f"this makes {len(mesh.faces)} faces; at most {inputs.largest} are allowed")
    warp, weft = warp_weft(mesh)
    stiffness, factor, strength = (inputs.one(name) for name in ("Stiffness", "Rest factor", "Strength"))
    rim = naked_vertices(mesh)
    everywhere = np.arange(len(mesh.vertices))
    pulls = _pulled(inputs, "Beams", mesh, rim, strength) + _pulled(inputs, "Arcs", mesh, everywhere, strength)
    ends = rim[_apart(mesh.vertices[rim], inputs.many("End arcs")).min(axis=0) <= inputs.tolerance]
    if not len(ends):
        raise InputError("/End arcs", "no vertex of the rim lies on one; they are the short edges of the surface")
    springs = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness, "rest_factor": factor}
        for name, pairs in (("across", weft), ("along", warp))
    ]
    scene = {
        "units": {"length": inputs.units, **_UNITS},
        "particles": mesh.vertices,
        "forces": [*springs, *pulls],
        "anchors": [{"particles": ends}],
        "settings": {"tolerance": 1e-10},
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    found = _net(result, mesh, "across", "along")
    return {
        **found,
        "Area": scenes.area(found["Mesh"]),
        "Moved": np.linalg.norm(result.particles - mesh.vertices, axis=1).max(),
        "Across": result.force("across")["force"],
        "Along": result.force("along")["force"],
    }


def _apart(points: Floats, curves: list[Any]) -> Floats:
    """Distances (curves, points)."""
    from hookean.discretize.closest import distances

    return np.array([distances(points, curve) for curve in curves])


def _pulled(inputs: Inputs, name: str, mesh: Mesh, chosen: Any, strength: float) -> list[dict[str, Any]]:
    """Pulls of the chosen vertices that lie on a curve of an input, each to the nearest."""
    from hookean.discretize.closest import polyline

    curves = inputs.many(name)
    apart = _apart(mesh.vertices[chosen], curves)
    near = apart.min(axis=0) <= inputs.tolerance
    if not near.any():
        raise InputError(f"/{name}", f"no vertex lies on one; the nearest is {apart.min():.6g} away")
    found = []
    for i in np.unique(apart.argmin(axis=0)[near]):
        rows = near & (apart.argmin(axis=0) == i)
        corners = polyline(curves[i], PIECES)
        closed = bool((corners[0] == corners[-1]).all())
        curve = {"curve": corners[:-1] if closed else corners, "closed": closed, "strength": strength}
        found.append({"kind": "pull_to_curve", "name": f"{name} {i + 1}", "particles": chosen[rows], **curve})
    return found


def _bridge(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize import mesh_surface
    from hookean.discretize.meshes import edges, naked_edges

    mesh = mesh_surface(inputs.surface("Skin"), inputs.one("Along"), inputs.one("Across"))
    units = {"length": inputs.units, **_UNITS}
    nets = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": inputs.one(title), "rest_factor": 0.0}
        for name, pairs, title in (("skin", edges(mesh), "Skin density"), ("edges", naked_edges(mesh), "Edge density"))
    ]
    scene = {
        "units": units,
        "particles": mesh.vertices,
        "forces": nets,
        "anchors": [{"name": n.lower(), "points": inputs.points(n)} for n in ("Feet", "Fingers")],
        "settings": {"tolerance": 1e-12},
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    feet, lift = np.array(result.reactions["names"]) == "feet", result.reactions["force"][:, 2]
    if inputs.one("Upside down"):
        result = scenes.relaxed(inputs, _reversed(result, feet, inputs.one("Concrete"), units), cancelled)
        carried = -float(lift[feet].sum())
    else:
        carried = float(lift[~feet].sum())
    found = _net(result, mesh, "skin", "edges")
    return {**found, "Area": scenes.area(found["Mesh"]), "Deck": carried}


def _reversed(result: Any, feet: Any, stiffness: float, units: Any) -> dict[str, Any]:
    """The found shape with every force turned round: a strut for each cable, the deck a load on the fingers."""
    struts = [
        {"kind": "springs", "name": c["name"], "particles": c["particles"], "stiffness": stiffness,
         "rest_length": c["length"] + c["force"] / stiffness}
        for c in result.forces
    ]  # fmt: skip
    held, pressed = result.reactions["particles"], -result.reactions["force"] * [0.0, 0.0, 1.0]
    return {
        "units": units,
        "particles": result.particles,
        "forces": [*struts, {"kind": "unary", "name": "deck", "particles": held[~feet], "vector": pressed[~feet]}],
        "anchors": [{"particles": held[feet]}, {"particles": held[~feet], "axes": "xy"}],
        "settings": {"max_iterations": 1000, **_STANDING},
    }


FUNCTIONS: dict[str, Function] = {
    "hanging_chain": Function(
        "Hanging chain",
        "Chain",
        "The vault's essay: a chain hangs from its ends, or, upside down, stands as an arch",
        (
            item("Arc length", "L", "Number", "Length of the chain [model unit]", 19.2, minimum=1e-6),
            item("Span", "B", "Number", "Distance of its ends [model unit]", 16.0, minimum=1e-6),
            count("Links", "N", "Links of equal length", 32, 2000, 2),
            item("Weight", "W", "Number", "Weight [kN/model unit]", 3.0, minimum=0.0),
            _in_kilonewtons(scenes.stiffness(1e7)),
            _OVER,
        ),
        (scenes.PARTICLES, scenes.SPRINGS, _FORCES, _REACTIONS, scenes.SUPPORTS,
         item("Height", "H", "Number", "Sag of the chain, or rise of the arch [model unit]"),
         item("Pull", "T", "Number", "Horizontal pull of the chain, or thrust of the arch [kN]"),
         _LARGEST, _LEAST, scenes.STATUS),
        _chain,
        "Figures",
    ),
    "vault": Function(
        "Vault",
        "Vault",
        "The vault's essay: a net hangs from nine columns, or, upside down, stands as a vault",
        (
            item("Length", "L", "Number", "Along x [model unit]", 20.0, minimum=1e-6),
            item("Width", "B", "Number", "Along y [model unit]", 14.0, minimum=1e-6),
            count("Along", "N", "Faces along x", 20, 150, 2),
            count("Across", "M", "Faces along y", 14, 150, 2),
            scenes.rest_factor(1.1, "Length factor", "R"),
            _in_kilonewtons(scenes.stiffness(1e4)),
            item("Weight", "W", "Number", "Weight of strings [kN/model unit]", 0.5, minimum=0.0),
            _OVER,
        ),
        (*_SHAPE, item("Height", "H", "Number", "Sag of the net, or rise of the vault [model unit]"),
         item("Total weight", "Wt", "Number", "Load of the columns [kN]"),
         item("Thrust at a corner", "T", "Number", "Horizontal force at a corner [kN]")),
        _vault,
        "Figures",
    ),
    "ribbon": Function(
        "Ribbon",
        "Ribbon",
        "Figure 9.32: a membrane stretched over free-form beams and arcs, along which it slides",
        (
            item("Surface", "S", "Surface", "The surface that is drawn, its long edges the beams"),
            Parameter("Beams", "B", "Curve", "Curves that the vertices of its rim slide along"),
            Parameter("Arcs", "A", "Curve", "Curves across it that the vertices on them slide along"),
            Parameter("End arcs", "E", "Curve", "Curves at its ends, where it is held"),
            count("Along", "N", "Faces along u, the beams", 60, 300),
            count("Across", "M", "Faces along v, the arcs", 20, 150),
            _in_kilonewtons(scenes.stiffness(4.0)),
            scenes.rest_factor(0.5),
            item("Strength", "P", "Number", "Strength of the pull to beams and arcs [kN/model unit]", 2000.0,
                 minimum=0.0),
        ),
        (*_SHAPE, item("Area", "A", "Number", "Area of the membrane [model unit^2]"),
         item("Moved", "D", "Number", "Largest distance from the drawing [model unit]"),
         Parameter("Across", "Fc", "Number", "Force of every spring from beam to beam [kN]"),
         Parameter("Along", "Fl", "Number", "Force of every spring along the beams [kN]")),
        _ribbon,
        "Figures",
    ),
    "bridge_skin": Function(
        "Bridge skin",
        "Bridge",
        "The Basento study: a skin between feet and fingers in tension, or every force reversed in compression",
        (
            item("Skin", "S", "Surface", "The surface that is drawn"),
            Parameter("Feet", "F", "Point", "Points of support [model unit]"),
            Parameter("Fingers", "G", "Point", "Points that carry the deck [model unit]"),
            count("Along", "N", "Faces along u", 32, 150),
            count("Across", "M", "Faces along v", 8, 150),
            item("Skin density", "q", "Number", "Force of the net by its length [kN/model unit]", 100.0, minimum=0.0),
            item("Edge density", "qe", "Number", "More of it along the rim [kN/model unit]", 200.0, minimum=0.0),
            item("Concrete", "k", "Number", "Stiffness of a strut [kN/model unit]", 5e6, minimum=1.0),
            _OVER,
        ),
        (*_SHAPE, item("Area", "A", "Number", "Area of the skin [model unit^2]"),
         item("Deck", "D", "Number", "Vertical force between deck and fingers [kN]")),
        _bridge,
        "Figures",
    ),
}  # fmt: skip
"""Functions by their names."""
