"""Drawing in the page by clicks on an empty page, for tests and for the pictures of the tutorial."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .browser import Studio
from .tasks import See, enter, solved


def blank(studio: Studio) -> None:
    """An empty page in m and kN, from the start page."""
    page = studio.page
    page.get_by_text("New model").click()
    page.get_by_label("Shape").select_option(label="Empty page")
    page.get_by_label("Unit of force").select_option("kN")
    studio.press("Make the empty page")
    page.get_by_label("Next corner").wait_for()


def spots(studio: Studio, *points: list[float]) -> Iterator[tuple[float, float]]:
    """Where points are on the page [CSS pixels], once the view has come to rest."""
    ask = "(point) => window.hookean.spot(point)"
    seen: list[Any] = [None, studio.page.evaluate(ask, points[0])]
    while seen[-1] != seen[-2]:
        studio.page.wait_for_timeout(150)
        seen.append(studio.page.evaluate(ask, points[0]))
    for point in points:
        found = studio.page.evaluate(ask, point)
        yield found["x"], found["y"]


def clicked(studio: Studio, *points: list[float]) -> None:
    """Click where points are seen."""
    for x, y in list(spots(studio, *points)):
        studio.page.mouse.move(x, y)
        studio.page.mouse.click(x, y)


def count(studio: Studio) -> int:
    return int(studio.service.summary(studio.key)["particles"])


def drawn(studio: Studio, particles: int) -> None:
    """Wait until there are so many particles, and the page draws them."""
    studio.until(lambda: count(studio) == particles and len(studio.particles()) == particles, what=str(particles))


def square(studio: Studio, see: See) -> None:
    """A net of 4 x 4 m by four clicks: divided twice, held along its edge, loaded inside, solved."""
    page, service = studio.page, studio.service
    blank(studio)
    studio.press("Faces")
    page.get_by_label("Faces become", exact=True).select_option(label="Springs")
    page.get_by_label("Name of faces").fill("net")
    page.get_by_text("Values of springs").click()
    become = page.get_by_role("group", name="Drawn faces")
    enter(studio, become.get_by_label("Stiffness", exact=True), "20")
    enter(studio, become.get_by_label("Rest factor", exact=True), "0.8")
    studio.press("Top")
    corners = [[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]]
    clicked(studio, *corners[:3])
    drawn(studio, 3)
    page.mouse.move(*next(spots(studio, corners[3])))
    see("net-corners")
    clicked(studio, corners[3])
    drawn(studio, 4)
    assert np.abs(studio.particles() - corners).max() == 0  # the grid makes clicks exact
    studio.press("Faces")  # the pen is put away
    page.get_by_text("Select several", exact=True).click()
    page.get_by_text("Change what is selected").click()
    for particles in (9, 25):
        studio.press("All")
        studio.press("Divide faces")
        drawn(studio, particles)
    held_and_loaded(studio, see)
    studio.until(lambda: len(service.scene(studio.key)["forces"]) == 2)
    solved(studio)
    studio.press("Perspective")
    see("net-form")


def held_and_loaded(studio: Studio, see: See) -> None:
    """The edge of the net held and kept as a group, and a load of 1 kN on each other particle."""
    page, service = studio.page, studio.service
    enter(studio, page.get_by_label("Particle number"), "0")
    studio.press("Edge loop")
    page.get_by_text("16 particles selected").wait_for()
    page.get_by_label("Name of the group").fill("edge")
    studio.press("Keep as a group")
    assert page.get_by_label("Colour of the group edge").input_value() == "#0072b2"
    studio.press("Hold the selected")
    studio.until(lambda: service.anchors(studio.key))
    see("net-held")
    studio.press("Invert")
    page.get_by_text("9 particles selected").wait_for()
    page.get_by_text("Add a force of any kind").click()
    page.get_by_label("Kind").select_option(label="Unary")
    page.get_by_label("On", exact=True).select_option(label="What is picked")
    enter(studio, page.locator("form.addforce").get_by_label("Vector", exact=True), "0 0 -1")
    page.get_by_role("button", name="Add unary", exact=True).click()
