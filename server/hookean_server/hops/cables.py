"""The chapter's figures of cables as functions of Hops: what a figure fixes is a parameter with the figure's value."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, item, optional
from hookean_server.workers.task import Cancelled

Floats = NDArray[np.float64]

_LENGTH = item("Length", "Lt", "Number", "Length of all springs [model unit]")
_SAG = item("Sag", "D", "Number", "How far the lowest particle lies below the first [model unit]")
_LARGEST = item("Largest force", "Fm", "Number", "The largest force of a spring [N]")
_TIME = item(
    "Time", "t", "Number", "Time since the start [s]; a frame every 0.05 s or 0.2 s", minimum=0.0, maximum=120.0
)
_SHAPE = (
    scenes.PARTICLES,
    scenes.SPRINGS,
    scenes.FORCES,
    scenes.REACTIONS,
    scenes.SUPPORTS,
    _LENGTH,
    _SAG,
    _LARGEST,
    scenes.STATUS,
)
_ENDS = optional(
    Parameter(
        "Anchors",
        "A",
        "Point",
        "Points where it is held: first, last and those between; default: (0, 0, 0), (10, 0, 0)",
    )
)
_DAMPING = item("Damping", "c", "Number", "Damping of every spring [N s/model unit]", 10.0, minimum=0.0)
_DRAG = item("Drag", "b", "Number", "Drag on every particle [N s/model unit]", 1.0, minimum=0.0)
_PIECES = count("Pieces", "N", "Number of springs", 10, 2000)


def _shape(result: Any) -> dict[str, Any]:
    """The outputs of a cable."""
    found = scenes.common(result, "cable")
    return {
        **found,
        "Length": result.force("cable")["length"].sum(),
        "Sag": result.particles[0, 2] - result.particles[:, 2].min(),
        "Largest force": found["Forces"].max(),
    }


def _cable(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    scene = _hung(inputs)
    return _shape(scenes.relaxed(inputs, scene, cancelled))


def _hung(inputs: Inputs) -> dict[str, Any]:
    """A straight cable between its first and last anchor, those between where they meet a particle."""
    anchors = inputs.points("Anchors")
    if not len(anchors):
        anchors = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    if len(anchors) < 2:
        raise InputError("/Anchors", "one anchor given; a cable needs two, one for each end")
    pieces = inputs.one("Pieces")
    points = scenes.row(anchors[0], anchors[-1], pieces)
    springs = {"kind": "springs", "name": "cable", "particles": scenes.chain(pieces),
               "stiffness": inputs.one("Stiffness"), "rest_factor": inputs.one("Length factor")}  # fmt: skip
    held: list[dict[str, Any]] = [{"name": "ends", "particles": [0, pieces]}]
    if len(anchors) > 2:
        held.append({"name": "between", "points": anchors[1:-1]})
    return {
        "particles": points,
        "forces": [springs, scenes.particles_of(points, inputs.one("Load"))],
        "anchors": held,
        "settings": {"tolerance": 1e-12},
    }


def _bouncing(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    scene = _hung(inputs)
    scene["forces"][0]["damping"] = inputs.one("Damping")
    scene["settings"] = {"solver": "verlet", "time_step": 0.001, "sub_iterations": 50, "drag": inputs.one("Drag"),
                         "tolerance": 1e-10}  # fmt: skip
    return _shape(scenes.moved(inputs, scene, inputs.one("Time"), cancelled))


def _smooth(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.arcs import interpolate

    result = scenes.relaxed(inputs, _hung(inputs), cancelled)
    curve = interpolate(result.particles, inputs.one("Samples"))
    found = _shape(result)
    return {**found, "Curve": curve, "Length of the curve": np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()}


def _hooke(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    rest, weight = inputs.one("Rest length"), inputs.one("Weight")
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -rest]])
    spring = {"kind": "springs", "name": "cable", "particles": [[0, 1]], "stiffness": inputs.one("Stiffness")}
    load = {"kind": "unary", "name": "load", "particles": [1], "vector": [0.0, 0.0, -weight]}
    scene = {"particles": points, "forces": [spring, load], "anchors": [{"particles": [0]}],
             "settings": {"tolerance": 1e-12}}  # fmt: skip
    result = scenes.relaxed(inputs, scene, cancelled)
    length = float(result.force("cable")["length"][0])
    spring_line = result.particles[[[0, 1]]]
    return {"Spring": spring_line[0], "Length": length, "Extension": length - rest, "Status": str(result.status)}


def arc(length: float, span: float, pieces: int) -> Floats:
    """Points (pieces + 1, 3) at equal lengths on the arc of a length that stands over a span; straight where both are
    the same."""
    from scipy.optimize import brentq

    if not span <= length < 1e3 * span:
        said = f"{length:g} given for a span of {span:g}; at least the span, at most 1000 times it allowed"
        raise InputError("/Arc length", said)
    if length == span:
        return scenes.row((0.0, 0.0, 0.0), (span, 0.0, 0.0), pieces)
    half = brentq(lambda t: length * np.sin(t) / t - span, 1e-9, np.pi, xtol=1e-15, rtol=1e-15)
    radius = 0.5 * length / half
    turn = np.linspace(-half, half, pieces + 1)
    height = radius * (np.cos(turn) - np.cos(half))
    return np.stack([0.5 * span + radius * np.sin(turn), np.zeros_like(turn), height], axis=1)


def _arched(inputs: Inputs) -> dict[str, Any]:
    """The arc as a chain that hardly stretches."""
    length, span, pieces = inputs.one("Arc length"), inputs.one("Span"), inputs.one("Pieces")
    points = arc(length, span, pieces)
    springs = {"kind": "springs", "name": "cable", "particles": scenes.chain(pieces),
               "stiffness": inputs.one("Stiffness"), "rest_factor": inputs.one("Rest factor")}  # fmt: skip
    return {
        "particles": points,
        "forces": [springs, scenes.particles_of(points, inputs.one("Load"))],
        "anchors": [{"name": "A and B", "particles": [0, pieces]}],
        "settings": {"tolerance": 1e-12},
    }


def _arc_to_catenary(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.catenary import catenary, catenary_of, parameter

    length, span, pieces = inputs.one("Arc length"), inputs.one("Span"), inputs.one("Pieces")
    scene = _arched(inputs)
    if inputs.one("By arc length"):
        scene["forces"][0]["rest_length"] = length / pieces
    result = scenes.relaxed(inputs, scene, cancelled)
    found = _shape(result)
    own = length if length > span else found["Length"]  # a line stretches: its own length then
    a = parameter(span, own)
    x, z = result.particles[:, 0] - 0.5 * span, result.particles[:, 2]
    off = z - z[0] - (catenary_of(a, x) - catenary_of(a, x[0]))
    drawn = catenary(result.particles[0], result.particles[-1], own, count=200)
    return {**found, "Catenary": drawn, "Off the catenary": np.abs(off).max()}


def _arc_frames(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    scene = _arched(inputs)
    scene["settings"] |= {"time_step": 0.0025, "sub_iterations": 80, "drag": inputs.one("Drag")}
    result = scenes.moved(inputs, scene, inputs.one("Time"), cancelled)
    return {**_shape(result), "Height of the middle": result.particles[inputs.one("Pieces") // 2, 2]}


def _frames(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.catenary import catenary
    from hookean.discretize.curves import divide

    number, links, factor = inputs.one("Chains"), inputs.one("Links"), inputs.one("Length factor")
    inputs.makes(number * links, "/Links")
    near, far = (divide(inputs.one(name), number) for name in ("Near frame", "Far frame"))
    closed = [np.allclose(side[0], side[-1]) for side in (near, far)]
    ends = [side[:-1] if all(closed) else side for side in (near, far)]
    points = np.linspace(ends[0], ends[1], links + 1, axis=1)
    number = len(points)
    pairs = scenes.chain(links)[None] + (links + 1) * np.arange(number)[:, None, None]
    springs = {"kind": "springs", "name": "cable", "particles": pairs.reshape(-1, 2),
               "stiffness": inputs.one("Stiffness"), "rest_factor": factor}  # fmt: skip
    flat = points.reshape(-1, 3)
    held = (links + 1) * np.arange(number)
    scene = {
        "particles": flat,
        "forces": [springs, scenes.particles_of(flat, inputs.one("Load"))],
        "anchors": [{"name": "frames", "particles": np.concatenate([held, held + links])}],
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    chains = result.particles.reshape(number, links + 1, 3)
    given = factor * np.linalg.norm(ends[1] - ends[0], axis=1)
    drawn = [catenary(c[0], c[-1], length, count=links) for c, length in zip(chains, given, strict=True)]
    lengths = result.force("cable")["length"].reshape(number, links).sum(axis=1)
    return {
        **_shape(result),
        "Chains": list(chains),
        "Lengths": lengths,
        "Largest sag": (points - chains)[:, :, 2].max(),
        "Off the catenaries": np.linalg.norm(chains - np.array(drawn), axis=2).max(),
    }


_ARC = (
    item("Arc length", "L", "Number", "Length of the arc [model unit]; the span: a straight line", 20.0, minimum=1e-6),
    item("Span", "B", "Number", "Distance of its ends [model unit]", 10.0, minimum=1e-6),
    replace(_PIECES, default=50),
    scenes.stiffness(7000.0),
    scenes.rest_factor(0.995),
    scenes.load(1.0),
)
_CABLE = (_ENDS, _PIECES, scenes.rest_factor(1.0, "Length factor", "R"), scenes.stiffness(1000.0), scenes.load(10.0))

FUNCTIONS: dict[str, Function] = {
    "cable": Function(
        "Cable",
        "Cable",
        "Figures 9.4, 9.7, 9.9 and 9.11: a line cut into springs hangs under its loads",
        _CABLE,
        _SHAPE,
        _cable,
        "Figures",
    ),
    "bouncing_cable": Function(
        "Bouncing cable",
        "Bouncing",
        "Figure 9.6: the cable in motion, at a time after its release",
        (*_CABLE, _DAMPING, _DRAG, replace(_TIME, default=0.9)),
        _SHAPE,
        _bouncing,
        "Figures",
    ),
    "smooth_curve": Function(
        "Smooth curve",
        "Smooth",
        "Figure 9.10: a smooth curve through the particles of a cable, for display",
        (
            _ENDS,
            replace(_PIECES, default=4),
            _CABLE[2],
            scenes.stiffness(200.0),
            scenes.load(40.0),
            count("Samples", "n", "Pieces of the curve", 4000, 100_000),
        ),
        (*_SHAPE, item("Curve", "C", "Curve", "The smooth curve as a polyline"),
         item("Length of the curve", "Lc", "Number", "Its length [model unit]")),
        _smooth,
        "Figures",
    ),
    "hooke": Function(
        "Hooke",
        "Hooke",
        "Figure 9.12: a spring under a weight, X = F / k",
        (
            item("Rest length", "L", "Number", "Length without a load [model unit]", 80.0, minimum=1e-6),
            scenes.stiffness(2.0),
            item("Weight", "P", "Number", "Weight that hangs on it [N]", 100.0, minimum=0.0),
        ),
        (
            item("Spring", "Sp", "Line", "The spring"),
            item("Length", "L", "Number", "Its length [model unit]"),
            item("Extension", "X", "Number", "Its elongation [model unit]"),
            scenes.STATUS,
        ),
        _hooke,
        "Figures",
    ),
    "arc_to_catenary": Function(
        "Arc to catenary",
        "ArcCatenary",
        "Figures 9.17 to 9.20: an arc whose springs hardly stretch becomes a catenary",
        (*_ARC, item("By arc length", "A", "Boolean", "Rest lengths from the arc, not from its chords", False)),
        (*_SHAPE, item("Catenary", "C", "Curve", "The exact catenary, as a polyline"),
         item("Off the catenary", "O", "Number", "Largest height of a particle over or below it [model unit]")),
        _arc_to_catenary,
        "Figures",
    ),
    "arc_frames": Function(
        "Arc frames",
        "ArcFrames",
        "Figure 9.21: an arc on its way down to the catenary, at a time after its release",
        (*_ARC, _DRAG, replace(_TIME, default=4.0)),
        (*_SHAPE, item("Height of the middle", "H", "Number", "Of its middle particle [model unit]")),
        _arc_frames,
        "Figures",
    ),
    "chains_between_frames": Function(
        "Chains between frames",
        "Chains",
        "Figure 9.22: chains hang between points at equal lengths on two frames",
        (
            item("Near frame", "A", "Curve", "A curve; where both are closed its start is one point with its end"),
            item("Far frame", "B", "Curve", "Another curve, of the same direction"),
            count("Chains", "N", "Number of chains", 48, 1000),
            count("Links", "n", "Links of each chain", 24, 500),
            scenes.rest_factor(1.2, "Length factor", "R"),
            scenes.stiffness(1e6),
            scenes.load(1.0),
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
