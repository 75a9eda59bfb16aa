"""A model from parameters alone: the page's shape at rest is what the Python API finds of the same scene."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax

from .browser import Studio


@pytest.mark.parametrize(
    ("shape", "typed", "particles"),
    [("Grid", {"Rise": "2", "Rest factor": "0"}, 121), ("Radial net", {"Rays": "8"}, 49), ("Cable", {}, 21)],
)
def test_a_model_is_made_and_solved(studio: Studio, shape: str, typed: dict[str, str], particles: int):
    """A hypar 10 x 10 m among them: (faces + 1)^2, 1 + rings x rays and springs + 1 particles."""
    page = studio.page
    page.get_by_text("New model").click()
    page.get_by_label("Shape").select_option(label=shape)
    for name, value in typed.items():
        page.get_by_label(name).fill(value)
        page.keyboard.press("Tab")
    studio.press(f"Make the {shape.lower()}")
    studio.drawing()
    scene = Scene.read(studio.service.scene(studio.key))
    assert (len(studio.particles()), scene.units.force) == (particles, "kN")
    studio.press("Solve")
    studio.service.at_rest(studio.key)
    truth = relax(scene).particles
    assert np.abs(studio.service.particles(studio.key) - truth).max() < 1e-3  # of 10 m
