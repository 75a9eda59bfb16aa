"""Kangaroo's solvers and settings, for the tables of the import."""

from __future__ import annotations

from dataclasses import replace

from hookean_canvas.kangaroo import held
from hookean_canvas.kangaroo.pieces import Piece, Swap

_ENGINE = {
    "iterations": "iterations",
    "particles": "particlesout",
    "geometry": "geometryout",
    "energy": "ke",
    "report": "out",
}
_PHYSICS = {"forceobjects": "forces", "anchorpoints": "anchors", "settings": "settings", "geometry": "geometry"}
_ENDS = "it ends at a residual (out-of-balance force over load), not at a speed or an energy"
_FRICTION = "friction is Coulomb's here (0.6 resting, 0.5 sliding), another law than the number typed in Kangaroo"
_BARE = "without Settings there is no floor"
_ENERGY = "the energy is that of all forces and of the motion, not of the motion alone"

SETTINGS = Swap(
    (
        Piece(
            "Settings",
            {
                "tolerance": "tolerance",
                "timestep": "time_step",
                "subiterations": "sub_iterations",
                "floor": "floor",
                "drag": "drag",
                "solver": "solver",
            },
            {"settings": "settings"},
            {"all_particles": True},
        ),
    ),
    "solvers 0 and 1 are verlet and yoshida; Archimedes, 2 and 3, is not here, and they are others if wired; "
    + _FRICTION,
    {
        "restitution": "the floor of the settings rebounds with 0.7; the component Floor takes another",
        "staticfriction": _FRICTION,
        "kineticfriction": _FRICTION,
        "settle": "bouncing ends by itself",
        "tumble": "sliding keeps the speed that friction leaves",
        "sound": "nothing sounds",
    },
    {"restitution": 0.7, "staticfriction": 10.0, "kineticfriction": 10.0, "settle": 2.0, "tumble": 1.0, "sound": False},
)

CLASSIC: dict[str, Swap] = {
    "kangaroophysics": Swap(
        (Piece("Engine", {**_PHYSICS, "simulationreset": "reset"}, _ENGINE, {"reset": False}),),
        f"{_ENERGY}; {_ENDS}; {_BARE}",
    ),
    "zombiekangaroo": Swap(
        (Piece("Engine", {**_PHYSICS, "simulationreset": "reset"}, _ENGINE, {"reset": False}),),
        f"the Engine plays on the service instead of holding the canvas; {_ENDS}",
        {"threshold": _ENDS, "maxiters": "the engine stops by itself; `max_iterations` of a scene limits it"},
    ),
    "kangaroosettings": SETTINGS,
}

_GOALS = {"goalobjects": "forces", "reset": "reset", "on": "on"}
_SOLVED = {"iterations": "i", "particles": "v", "geometry": "o"}
_OUT = "geometry comes out as Show takes it in, or as the goals' lines where nothing is shown, in its own tree"
_STEPS = "the Engine runs while reset is False and _on_ True"


def _solver(solver: str, differs: str, **without: str) -> Swap:
    values = {"solver": solver, "all_particles": True} | ({"fast": True} if "holding the canvas" in differs else {})
    steps = dict.fromkeys(("iterations", "subiterations"), "sub_iterations")
    settings = Piece("Settings", {"tolerance": "tolerance", **steps}, values=values, feeds={"settings": "0.settings"})
    usual = {
        "threshold": None,
        "restart": False,
        "addcurrent": False,
        "damping": 0.99,
        "momentum": False,
        "maxiterations": 50000,
        "animate": True,
        "parallel": True,
    }
    told = {"threshold": _ENDS, **without}
    engine = Piece("Engine", _GOALS, _SOLVED, {"reset": False})
    return Swap((engine, settings), f"{differs}; {_OUT}", told, usual, idle=("parallel",))


_BOUNCY = _solver(
    "bouncy",
    "goals are weighted as by Solver and 0.99 of the velocity is kept, or the damping if another is given; Kangaroo's "
    "law is not published, so the motion may be another; the shape at rest is the same",
    damping="a step of 0.01 with a drag of 1 keeps 0.99 of the velocity",
)

SECOND: dict[str, Swap] = {
    "solver": _solver(
        "momentum",
        "the same iteration, played on the service",
        points="particles come from the forces",
        restart="reset does both",
        addcurrent="particles come from the forces",
        parallel="the service decides that",
    ),
    "bouncysolver": replace(
        _BOUNCY, unless={"damping": ""}, other=replace(_BOUNCY, pieces=(*_BOUNCY.pieces, held.BOUNCY))
    ),
    "zombiesolver": _solver(
        "momentum",
        "the Engine plays on the service instead of holding the canvas",
        maxiterations="the engine stops by itself",
    ),
    "stepsolver": _solver(
        "momentum",
        "the Engine plays on instead of waiting for each step",
        momentum="choose the solver in Settings",
        damping="drag of Settings",
        animate=_STEPS,
    ),
}
