"""Figure 9.22: chains between two free-form frames, over the catenaries drawn from their ends and lengths."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.discretize.catenary import catenary
from hookean.discretize.curves import divide
from hookean.files.relax_file import read_scene
from hookean.files.rhino import threedm
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    result = relax(scene)
    springs = scene.forces[0]
    links = len(springs.lines) // (len(scene.anchors[0].points) // 2)
    # springs come chain by chain, each from the near frame to the far one
    pairs = result.force("chains")["particles"].reshape(-1, links, 2)
    chains = result.particles[np.concatenate([pairs[:, :, 0], pairs[:, -1:, 1]], axis=1)]
    given = springs.rest_factor * np.linalg.norm(chains[:, -1] - chains[:, 0], axis=1)
    drawn = np.array([catenary(c[0], c[-1], length, count=links) for c, length in zip(chains, given, strict=True)])
    lengths = result.force("chains")["length"].reshape(-1, links).sum(axis=1)
    straight = np.linspace(chains[:, 0], chains[:, -1], links + 1, axis=1)
    frames = [o.geometry for o in threedm.read(folder / "model.3dm").objects if o.layer == "frames"]
    ends = np.stack([divide(frame, len(chains))[:-1] for frame in frames], axis=1)
    numbers = {
        "chains": len(chains),
        "ends off equal parts of the frames": np.linalg.norm(chains[:, [0, -1]] - ends, axis=2).max(),
        "total length": lengths.sum(),
        "shortest chain": lengths.min(),
        "longest chain": lengths.max(),
        "largest sag": (straight - chains)[:, :, 2].max(),
        "largest force": result.force("chains")["force"].max(),
        "chains off the catenaries": np.linalg.norm(chains - drawn, axis=2).max(),
    }
    curves = {f"{name} frame": divide(frame, 400) for name, frame in zip(("near", "far"), frames, strict=True)}
    view = (-52.0, 24.0)
    return Outcome(
        numbers,
        [
            Panel(result, scene, "Chains, relaxed", view, curves=curves),
            Panel(title="Catenaries, drawn from ends and length", view=view,
                  curves={"catenaries": to_and_fro(drawn), **curves}),
        ],
        columns=2,
    )  # fmt: skip


def to_and_fro(drawn: np.ndarray) -> np.ndarray:
    """All curves (n, k, 3) as one line, every second one backwards."""
    return np.concatenate([curve[:: 1 - 2 * (i % 2)] for i, curve in enumerate(drawn)])
