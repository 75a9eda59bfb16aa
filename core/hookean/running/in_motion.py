"""Scenes made fit to be played, where nobody chose how."""

from __future__ import annotations

from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.stability.time_steps import floored, longest
from hookean.system.system import compile

MOST_STEPS = 200  # in a frame


def in_motion(scene: Scene) -> tuple[Scene, str]:
    """A scene for a simulation that is played: where nobody chose its time step and the usual one would be divided,
    with a shorter one and a sentence on it; else the scene as it is, and "".

    Where nobody chose how many steps make a frame, it is as long as usual, in at most MOST_STEPS.
    """
    settings = scene.settings
    if not settings.divide_steps or settings.solver not in ("auto", "verlet", "yoshida"):
        return scene, ""
    system = compile(scene)
    method = solver("verlet" if settings.solver == "auto" else settings.solver)
    holds = longest(system, system.start(), method.limit)
    if settings.time_step <= holds:
        return scene, ""
    step = float(f"{floored(holds):.4g}")
    changed: dict[str, float] = {"time_step": step, "divide_steps": True}
    if "sub_iterations" not in settings.model_fields_set:
        changed["sub_iterations"] = min(round(settings.sub_iterations * settings.time_step / step), MOST_STEPS)
    said = f"time steps of {step:g} {scene.units.time} are used; longer ones are unstable with this stiffness and mass"
    return scene.replaced(settings=settings.replaced(**changed)), said
