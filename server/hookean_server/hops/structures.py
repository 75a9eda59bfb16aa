"""The chapter's larger figures as functions of Hops: chain and net hung and turned over, the ribbon, the bridge's
skin."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hookean.commands.examples import figure
from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, inputs_of, item
from hookean_server.workers.task import Cancelled

_VAULT = figure("hanging-vault")
_RIBBON = figure("9.32-ribbon").scene
_BRIDGE = figure("basento")


def _in_kilonewtons(parameter: Parameter) -> Parameter:
    return replace(parameter, description=parameter.description.replace("[N", "[kN"))


_FORCES, _REACTIONS, _STIFFNESS = (
    _in_kilonewtons(parameter) for parameter in (scenes.FORCES, scenes.REACTIONS, scenes.STIFFNESS)
)
_LARGEST = item("Largest force", "Fm", "Number", "The largest force, tension positive [kN]")
_LEAST = item("Least force", "Fn", "Number", "The smallest force, tension positive [kN]")
_SHAPE = (scenes.MESH, scenes.SPRINGS, _FORCES, _REACTIONS, scenes.SUPPORTS, _LARGEST, _LEAST, scenes.STATUS)
_OVER = item("Upside down", "U", "Boolean", "True: upside down, with every force reversed", False)


def _net(result: Any, scene: Scene, *names: str) -> dict[str, Any]:
    found = scenes.common(result, *names)
    forces = found["Forces"]
    (drawn,) = scene.meshes.values()
    return {
        **found,
        "Mesh": Mesh(result.particles, drawn.faces),
        "Largest force": forces.max(),
        "Least force": forces.min(),
    }


def _hung(inputs: Inputs, scene: Scene, cancelled: Cancelled) -> Any:
    """The equilibrium of a hanging scene, or of what stands when it is turned over; the name of its elements."""
    result = scenes.relaxed(inputs, scene, cancelled)
    if not inputs.one("Upside down"):
        return result, str(scene.forces[0].name)
    standing = _VAULT.upside_down(result, inputs.one("Stiffness"))
    return scenes.relaxed(inputs, standing, cancelled, tolerance=1e-9), "struts"


def _chain(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    result, name = _hung(inputs, inputs.make(_VAULT.chain), cancelled)
    found = scenes.common(result, name)
    return {
        **found,
        "Height": np.abs(result.particles[:, 2]).max(),
        "Pull": np.abs(found["Reactions"][0][0]),
        "Largest force": found["Forces"].max(),
        "Least force": found["Forces"].min(),
    }


def _vault(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    scene = inputs.make(_VAULT.scene)
    result, name = _hung(inputs, scene, cancelled)
    found = _net(result, scene, name)
    pull = found["Reactions"]
    return {
        **found,
        "Height": np.abs(result.particles[:, 2]).max(),
        "Total weight": pull[:, 2].sum(),
        "Thrust at a corner": np.hypot(*pull[0, :2]),
    }


def _ribbon(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize import area

    scene = inputs.make(_RIBBON, tolerance=inputs.tolerance)
    faces = len(scene.meshes["membrane"].faces)
    if faces > inputs.largest:
        raise InputError("/Along", f"this makes {faces} faces; at most {inputs.largest} are allowed")
    result = scenes.relaxed(inputs, scene, cancelled)
    found = _net(result, scene, "across", "along")
    return {
        **found,
        "Area": area(found["Mesh"]),
        "Moved": np.linalg.norm(result.particles - scene.particles, axis=1).max(),
        "Across": result.force("across")["force"],
        "Along": result.force("along")["force"],
    }


def _bridge(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize import area

    scene = inputs.make(_BRIDGE.scene)
    result = scenes.relaxed(inputs, scene, cancelled)
    feet, lift = np.array(result.reactions["names"]) == "feet", result.reactions["force"][:, 2]
    if inputs.one("Upside down"):
        result = scenes.relaxed(inputs, _BRIDGE.reverse(result, inputs.one("Concrete")), cancelled)
        carried = -float(lift[feet].sum())
    else:
        carried = float(lift[~feet].sum())
    found = _net(result, scene, "skin", "edges")
    return {**found, "Area": area(found["Mesh"]), "Deck": carried}


FUNCTIONS: dict[str, Function] = {
    "hanging_chain": Function(
        "Hanging chain",
        "Chain",
        "The vault's essay: a chain hangs from its ends, or, upside down, stands as an arch",
        inputs_of(
            _VAULT.chain,
            item("Arc length", "L", "Number", "Length of the chain [model unit]", minimum=1e-6),
            item("Span", "B", "Number", "Distance of its ends [model unit]", minimum=1e-6),
            count("Links", "N", "Links of equal length", None, 2000, 2),
            item("Weight", "W", "Number", "Weight [kN/model unit]", minimum=0.0),
            _STIFFNESS,
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
        inputs_of(
            _VAULT.scene,
            item("Length", "L", "Number", "Along x [model unit]", minimum=1e-6),
            item("Width", "B", "Number", "Along y [model unit]", minimum=1e-6),
            count("Along", "N", "Faces along x", None, 150, 2),
            count("Across", "M", "Faces along y", None, 150, 2),
            scenes.LENGTH_FACTOR,
            _STIFFNESS,
            item("Weight", "W", "Number", "Weight of strings [kN/model unit]", minimum=0.0),
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
        inputs_of(
            _RIBBON,
            item("Surface", "S", "Surface", "The surface that is drawn, its long edges the beams"),
            Parameter("Beams", "B", "Curve", "Curves that the vertices of its rim slide along"),
            Parameter("Arcs", "A", "Curve", "Curves across it that the vertices on them slide along"),
            Parameter("End arcs", "E", "Curve", "Curves at its ends, where it is held"),
            count("Along", "N", "Faces along u, the beams", None, 300),
            count("Across", "M", "Faces along v, the arcs", None, 150),
            _STIFFNESS,
            scenes.REST_FACTOR,
            item("Strength", "P", "Number", "Strength of the pull to beams and arcs [kN/model unit]", minimum=0.0),
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
        inputs_of(
            _BRIDGE.scene,
            item("Skin", "S", "Surface", "The surface that is drawn"),
            Parameter("Feet", "F", "Point", "Where it stands [model unit]"),
            Parameter("Fingers", "G", "Point", "Where the deck rests [model unit]"),
            count("Along", "N", "Faces along u", None, 150),
            count("Across", "M", "Faces along v", None, 150),
            item("Skin density", "q", "Number", "Force of the net by its length [kN/model unit]", minimum=0.0),
            item("Edge density", "qe", "Number", "More of it along the rim [kN/model unit]", minimum=0.0),
            item("Concrete", "k", "Number", "Stiffness of a strut [kN/model unit]", _BRIDGE.CONCRETE, minimum=1.0),
            _OVER,
        ),
        (*_SHAPE, item("Area", "A", "Number", "Area of the skin [model unit^2]"),
         item("Deck", "D", "Number", "Vertical force between deck and fingers [kN]")),
        _bridge,
        "Figures",
    ),
}  # fmt: skip
"""Functions by their names."""
