"""The chapter's figures of cables as functions of Hops: what a figure fixes is a parameter with the figure's value."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hookean.commands.examples import figure
from hookean.scene.scene import Scene
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, inputs_of, item, optional
from hookean_server.workers.task import Cancelled

_CABLE = figure("9.4-cable").scene
_BOUNCING = figure("9.6-bouncing").scene
_SMOOTH = figure("9.10-smooth-curve").scene
_HOOKE = figure("9.12-hooke").scene
_ARC = figure("9.17-arc-to-catenary").scene
_FALLING_ARC = figure("9.21-arc-frames").scene
_CHAINS = figure("9.22-freeform-frames").scene

_SAG = item("Sag", "D", "Number", "How far the lowest particle lies below the first [model unit]")
_TIME = item(
    "Time", "t", "Number", "Time since the start [s]; a frame every 0.05 s or 0.2 s", minimum=0.0, maximum=120.0
)
_SHAPE = (scenes.PARTICLES, scenes.SPRINGS, scenes.FORCES, scenes.REACTIONS, scenes.SUPPORTS, scenes.LENGTH, _SAG,
          scenes.LARGEST, scenes.STATUS)  # fmt: skip
_ENDS = optional(
    Parameter(
        "Anchors",
        "A",
        "Point",
        "Points where it is held: first, last and those between; default: (0, 0, 0), (10, 0, 0)",
    )
)
_DAMPING = item("Damping", "c", "Number", "Damping of every spring [N s/model unit]", minimum=0.0)
_DRAG = item("Drag", "b", "Number", "Drag on every particle [N s/model unit]", minimum=0.0)
_PIECES = count("Pieces", "N", "Number of springs", None, 2000)


def _shape(inputs: Inputs, scene: Scene, result: Any, name: str = "cable") -> dict[str, Any]:
    """The outputs of a cable."""
    found = scenes.common(result, name)
    return {
        **found,
        "Length": result.force(name)["length"].sum(),
        "Sag": result.particles[0, 2] - result.particles[:, 2].min(),
        "Largest force": found["Forces"].max(),
    }


def _smooth(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    from hookean.discretize.arcs import interpolate

    curve = interpolate(result.particles, inputs.one("Samples"))
    found = _shape(inputs, scene, result)
    return {**found, "Curve": curve, "Length of the curve": np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()}


def _hooke(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    length = float(result.force("cable")["length"][0])
    return {
        "Spring": result.particles,
        "Length": length,
        "Extension": length - inputs.one("Rest length"),
        "Status": str(result.status),
    }


def _arc_to_catenary(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    from hookean.discretize.catenary import catenary, catenary_of, parameter

    length, span = inputs.one("Arc length"), inputs.one("Span")
    found = _shape(inputs, scene, result)
    own = length if length > span else found["Length"]  # a line stretches: its own length then
    a = parameter(span, own)
    x, z = result.particles[:, 0] - 0.5 * span, result.particles[:, 2]
    off = z - z[0] - (catenary_of(a, x) - catenary_of(a, x[0]))
    drawn = catenary(result.particles[0], result.particles[-1], own, count=200)
    return {**found, "Catenary": drawn, "Off the catenary": np.abs(off).max()}


def _arc_frames(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    return {**_shape(inputs, scene, result), "Height of the middle": result.particles[inputs.one("Pieces") // 2, 2]}


def _frames(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.catenary import catenary

    links = inputs.one("Links")
    inputs.makes(inputs.one("Chains") * links, "/Links")
    scene = inputs.make(_CHAINS)
    result = scenes.relaxed(inputs, scene, cancelled)
    points, chains = (x.reshape(-1, links + 1, 3) for x in (scene.particles, result.particles))
    given = inputs.one("Length factor") * np.linalg.norm(points[:, -1] - points[:, 0], axis=1)
    drawn = [catenary(c[0], c[-1], length, count=links) for c, length in zip(chains, given, strict=True)]
    return {
        **_shape(inputs, scene, result, "chains"),
        "Chains": list(chains),
        "Lengths": result.force("chains")["length"].reshape(-1, links).sum(axis=1),
        "Largest sag": (points - chains)[:, :, 2].max(),
        "Off the catenaries": np.linalg.norm(chains - np.array(drawn), axis=2).max(),
    }


_SPRINGS = (_ENDS, _PIECES, scenes.LENGTH_FACTOR, scenes.STIFFNESS, scenes.LOAD)
_ARCHED = (
    item("Arc length", "L", "Number", "Length of the arc [model unit]; the span: a straight line", minimum=1e-6),
    item("Span", "B", "Number", "Distance of its ends [model unit]", minimum=1e-6),
    _PIECES,
    scenes.STIFFNESS,
    scenes.REST_FACTOR,
    scenes.LOAD,
)

FUNCTIONS: dict[str, Function] = {
    "cable": scenes.relaxing(
        _CABLE, _shape, "Cable", "Cable",
        "Figures 9.4, 9.7, 9.9 and 9.11: a line cut into springs hangs under its loads",
        _SPRINGS,
        _SHAPE,
    ),
    "bouncing_cable": scenes.moving(
        _BOUNCING, _shape, "Bouncing cable", "Bouncing",
        "Figure 9.6: the cable in motion, at a time since it was let go",
        (*_SPRINGS, _DAMPING, _DRAG, replace(_TIME, default=0.9)),
        _SHAPE,
    ),
    "smooth_curve": scenes.relaxing(
        _SMOOTH, _smooth, "Smooth curve", "Smooth",
        "Figure 9.10: a smooth curve through the particles of a cable, for display",
        (*_SPRINGS, count("Samples", "n", "Pieces of the curve", 4000, 100_000)),
        (*_SHAPE, item("Curve", "C", "Curve", "The smooth curve as a polyline"),
         item("Length of the curve", "Lc", "Number", "Its length [model unit]")),
    ),
    "hooke": scenes.relaxing(
        _HOOKE, _hooke, "Hooke", "Hooke",
        "Figure 9.12: a spring under a weight, X = F / k",
        (
            item("Rest length", "L", "Number", "Length without a load [model unit]", minimum=1e-6),
            scenes.STIFFNESS,
            item("Weight", "P", "Number", "What hangs on it [N]", minimum=0.0),
        ),
        (
            item("Spring", "Sp", "Line", "The spring"),
            item("Length", "L", "Number", "Its length [model unit]"),
            item("Extension", "X", "Number", "Its elongation [model unit]"),
            scenes.STATUS,
        ),
    ),
    "arc_to_catenary": scenes.relaxing(
        _ARC, _arc_to_catenary, "Arc to catenary", "ArcCatenary",
        "Figures 9.17 to 9.20: an arc whose springs hardly stretch becomes a catenary",
        (*_ARCHED, item("By arc length", "A", "Boolean", "Rest lengths from the arc, not from its chords")
        ),
        (*_SHAPE, item("Catenary", "C", "Curve", "The catenary to compare with, as a polyline"),
         item("Off the catenary", "O", "Number", "Largest height of a particle over or below it [model unit]")),
    ),
    "arc_frames": scenes.moving(
        _FALLING_ARC, _arc_frames, "Arc frames", "ArcFrames",
        "Figure 9.21: an arc on its way down to the catenary, at a time since it was let go",
        (*_ARCHED, _DRAG, replace(_TIME, default=4.0)),
        (*_SHAPE, item("Height of the middle", "H", "Number", "Of its middle particle [model unit]")),
    ),
    "chains_between_frames": Function(
        "Chains between frames",
        "Chains",
        "Figure 9.22: chains hang between points at equal lengths on two frames",
        inputs_of(
            _CHAINS,
            item("Near frame", "A", "Curve", "A curve; where both are closed its start is one point with its end"),
            item("Far frame", "B", "Curve", "Another curve, of the same direction"),
            count("Chains", "N", "Number of chains", None, 1000),
            count("Links", "n", "Links of each chain", None, 500),
            scenes.LENGTH_FACTOR,
            scenes.STIFFNESS,
            scenes.LOAD,
        ),
        (*_SHAPE, Parameter("Chains", "C", "Curve", "The chains as polylines"),
         Parameter("Lengths", "Lc", "Number", "Length of each chain [model unit]"),
         item("Largest sag", "Dm", "Number", "Of a particle, from where it was drawn [model unit]"),
         item("Off the catenaries", "O", "Number", "Largest distance of a particle from its catenary [model unit]")),
        _frames,
        "Figures",
    ),
}  # fmt: skip
"""Functions by their names."""
