"""A balloon and a pair of bubbles: gas by Boyle's law, film by Laplace's, and three films that meet at 120 degrees."""

from pathlib import Path

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.discretize import naked_vertices
from hookean.pictures.sheet import Graph, Panel

COARSE = 5  # squares a side, half of the scene's: what both find gives the limit of fine meshes
BALL, PAIR = 4.0 / 3.0 * np.pi, 9.0 / 8.0 * np.pi  # volume over radius^3: of a sphere, of a bubble of two alike


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    scene = module.scene()
    result = relax(scene)
    coarse = relax(module.scene(divisions=COARSE))
    balloon, left, right = gas(result, "balloon"), gas(result, "left"), gas(result, "right")
    radius = np.cbrt(balloon[0] / BALL)
    out = distances(result)
    rim, apex = rim_and_apex(result)
    numbers = {
        "balloon: pressure, in the limit of fine meshes": limit(gas(coarse, "balloon")[1], balloon[1]),
        "balloon: pressure over 2 T / R": balloon[1] * radius / (2.0 * given["tension"]),
        "balloon: absolute pressure times volume": (balloon[1] + given["outside"]) * balloon[0],
        "balloon: greatest less least radius": np.ptp(out),
        "pair: pressure, in the limit of fine meshes": limit(gas(coarse, "left")[1], left[1]),
        "pair: difference of their pressures": left[1] - right[1],
        "pair: angle of wall and caps": np.degrees(2.0 * np.arctan(apex / rim)),
        "pair: distance of the wall from its plane, largest": np.abs(wall(result)[:, 0] - module.SIDE).max(),
    }
    panel = Panel(result, scene, "a balloon, and two bubbles with a wall", view=(-70.0, 18.0))
    return Outcome(numbers, [panel, graph(given, balloon, left)])


def gas(result: Result, name: str) -> tuple[float, float]:
    """Volume [m3] and pressure over that outside [Pa]."""
    columns = result.force(f"gas {name}")
    return float(columns["volume"][0]), float(columns["pressure"][0])


def limit(coarse: float, fine: float) -> float:
    """What meshes tend to whose error is a quarter for half the size of their faces (Richardson)."""
    return (4.0 * fine - coarse) / 3.0


def distances(result: Result) -> np.ndarray:
    """Of the balloon's vertices from their middle [m]."""
    x = geometry(result, "film")["vertices"]
    return np.linalg.norm(x - x.mean(axis=0), axis=1)


def wall(result: Result) -> np.ndarray:
    return np.asarray(geometry(result, "wall")["vertices"])


def geometry(result: Result, name: str) -> dict:
    return next(item for item in result.geometry if item["name"] == name)


def rim_and_apex(result: Result) -> tuple[float, float]:
    """Radius of the wall's rim and height of the left cap over it [m]."""
    mesh = geometry(result, "wall")
    x = wall(result)
    rim = x[naked_vertices((x, mesh["faces"]))]
    middle = rim.mean(axis=0)
    cap = geometry(result, "left cap")["vertices"]
    return float(np.linalg.norm(rim - middle, axis=1).mean()), float(middle[0] - cap[:, 0].min())


def graph(given: dict, balloon: tuple[float, float], pair: tuple[float, float]) -> Graph:
    """Pressure by volume: of the gas, and of the films that hold it."""
    volume = np.linspace(1.9, 2.9, 101)
    film = {name: 2.0 * given["tension"] / np.cbrt(volume / size) for name, size in (("a film", BALL), ("two", PAIR))}
    return Graph(
        "Boyle and Laplace", "volume of the gas [m3]", "pressure over that outside [Pa]",
        lines={
            "gas, Boyle": (volume, given["pressure"] / volume - given["outside"]),
            "balloon, 2 T / R": (volume, film["a film"]),
            "bubble of a pair, 2 T / R": (volume, film["two"]),
        },
        dots={"hookean": (np.array([balloon[0], pair[0]]), np.array([balloon[1], pair[1]]))},
    )  # fmt: skip
