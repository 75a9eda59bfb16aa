"""Circles in round boundaries: the forces of tight packings, and the radius at which nineteen circles just fit."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

NEARLY = (4.862, 4.863)  # m: two boundaries a little too small for nineteen


@dataclass
class Packing:
    """A packing at rest: places from the centre of its boundary [m], contacts as pairs, and forces [N]."""

    places: np.ndarray
    pairs: np.ndarray
    contacts: np.ndarray
    wall: np.ndarray

    @property
    def virial(self) -> float:
        """Contacts times distances over wall forces times distances from the centre, which is 1 in equilibrium."""
        apart = np.linalg.norm(self.places[self.pairs[:, 0]] - self.places[self.pairs[:, 1]], axis=1)
        return float(self.contacts @ apart / (self.wall @ np.linalg.norm(self.places, axis=1)))


def packings(result: Result, counts: tuple[int, ...], radius: float, stiffness: float) -> list[Packing]:
    """The packings of a result, one by one."""
    wall, found, first = result.force("boundary")["force"], [], 0
    for i, count in enumerate(counts):
        places = result.particles[len(counts) + first :][:count] - result.particles[i]
        one, other = np.triu_indices(count, 1)
        overlap = 2.0 * radius - np.linalg.norm(places[one] - places[other], axis=1)
        touch = overlap > 0.0
        pairs = np.column_stack([one, other])[touch]
        found.append(Packing(places, pairs, stiffness * overlap[touch], wall[first : first + count]))
        first += count
    return found


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    counts, size, stiffness = given["counts"], given["radius"], given["stiffness"]
    scene = module.scene()
    result = relax(scene)
    seven, nineteen, many = packings(result, counts, size, stiffness)
    close = relax(module.scene(counts=(19, 19), boundaries=NEARLY))
    less, more = (packing.wall.max() for packing in packings(close, (19, 19), size, stiffness))
    fits = NEARLY[1] + (NEARLY[1] - NEARLY[0]) * more / (less - more)
    rings = np.sort(np.linalg.norm(nineteen.places, axis=1))
    numbers = {
        "seven: force between circles": seven.contacts.max(),
        "seven: force of the boundary on a circle": seven.wall.max(),
        "nineteen: radius of the inner ring": rings[1:7].mean(),
        "nineteen: radius of the outer ring": rings[7:].mean(),
        "nineteen: force of the boundary on a circle": nineteen.wall.max(),
        "nineteen: largest force between circles": nineteen.contacts.max(),
        "nineteen: boundary in which they just fit": fits,
        "ninety-one: forces times distances, circles over boundary": many.virial,
    }
    shown = drawn(result, [seven, nineteen, many], module, given)
    panel = Panel(shown, title="7, 19 and 91 circles of 1 m", view="top")
    return Outcome(numbers, [panel, graph(module, stiffness)], columns=1)


def drawn(result: Result, packed: list[Packing], module: ModuleType, given: dict[str, Any]) -> Result:
    """The result as its picture shows it: outlines of circles and boundaries, and lines between those that touch."""
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    outline = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    centres = module.centres_of(given["boundaries"])
    rounds = [centre + size * outline for centre, size in zip(centres, given["boundaries"], strict=True)]
    rounds += [x + given["radius"] * outline for x in result.particles[len(centres) :]]
    first = np.cumsum([len(centres), *(len(packing.places) for packing in packed)])
    pairs = np.concatenate([packing.pairs + at for packing, at in zip(packed, first, strict=False)])
    pushes = np.concatenate([packing.contacts for packing in packed])
    return replace(
        result,
        geometry=[{"name": "", "kind": "polyline", "points": points} for points in rounds],
        forces=[{"name": "contacts", "kind": "springs", "particles": pairs, "force": -pushes}],
        reactions={name: rows[:0] for name, rows in result.reactions.items()},
    )


def graph(module: ModuleType, stiffness: float) -> Graph:
    """Forces of boundaries on circles, by the radius of the boundary."""
    lines, dots = {}, {}
    for count, tight in ((7, 3.0), (19, 1.0 + np.sqrt(2.0) + np.sqrt(6.0))):
        sizes = tight - np.array([0.05, 0.04, 0.03, 0.02, 0.01, 0.005])
        close = relax(module.scene(counts=6 * (count,), boundaries=sizes))
        pushes = [packing.wall.max() for packing in packings(close, 6 * (count,), 1.0, stiffness)]
        dots[f"{count} circles"] = (sizes - tight, np.array(pushes))
        lines[f"{count} circles"] = (np.append(sizes - tight, 0.0), np.array([*pushes, 0.0]))
    return Graph(
        "No force where they just fit",
        "boundary, from the one in which they just fit [m]",
        "force of the boundary on a circle [N]",
        lines=lines,
        dots=dots,
    )
