"""Figure 9.16: the catenary between A and B, of a length and under a gravity direction, and chains that hang on it."""

from pathlib import Path

import numpy as np

from hookean import InputError, Scene, relax
from hookean.commands.examples import Outcome, figure
from hookean.discretize.catenary import catenary, parameter, tensions
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    numbers: dict[str, float] = {}
    panels = []
    made = figure(folder)
    for name, parameters in made.CASES.items():
        scene = made.scene(**parameters)
        start, end, length, gravity = inputs(scene)
        drawn = catenary(start, end, length, count=len(scene.particles) - 1, gravity=gravity)
        pull = tensions(start, end, length, gravity=gravity, weight=1.0)
        result = relax(scene)
        numbers[f"{name}: a"] = a = parameter_of(start, end, length, gravity)
        # the directrix is as far below A as the tension there tells, the lowest point a above the directrix
        numbers[f"{name}: depth below A"] = pull[0] - a
        numbers[f"{name}: largest tension"] = pull.max()
        numbers[f"{name}: chain off the catenary"] = np.linalg.norm(result.particles - drawn, axis=1).max()
        panels.append(Panel(result, scene, f"{name}: L = {length:g} m", "front", curves={"drawn": drawn}))
    numbers["lengths refused"] = refused(start, end, gravity)
    return Outcome(numbers, panels, columns=3)


def inputs(scene: Scene) -> tuple[np.ndarray, np.ndarray, float, np.ndarray]:
    """A, B [m], L [m] and G of the chain in a scene: what the catenary is drawn from."""
    springs, weight = scene.forces[:2]
    length = float(springs.rest_length * len(springs.particles))
    return scene.particles[0], scene.particles[-1], length, weight.vector


def parameter_of(start: np.ndarray, end: np.ndarray, length: float, gravity: np.ndarray) -> float:
    chord = end - start
    rise = chord @ gravity / np.linalg.norm(gravity)
    return parameter(np.sqrt(chord @ chord - rise**2), length, rise)


def refused(start: np.ndarray, end: np.ndarray, gravity: np.ndarray) -> int:
    """How many of three lengths below the shortest possible one, the distance of A and B, are refused."""
    count = 0
    for part in (0.5, 0.9, 0.999999):
        try:
            catenary(start, end, part * np.linalg.norm(end - start), gravity=gravity)
        except InputError:
            count += 1
    return count
