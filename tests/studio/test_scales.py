"""Scales of colours: typed ends, symmetric, logarithmic; colours that differ for all kinds of eyes; what is picked
stands out from all of them; guides are drawn."""

from __future__ import annotations

import re
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from hookean import family
from soak import sampled

from .browser import Studio, net

STRETCHED: dict[str, Any] = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [5, 0, 0]],
    "forces": [
        {
            "kind": "springs",
            "particles": [[i, i + 1] for i in range(5)],
            "stiffness": 1000.0,
            "force": [-10.0, 0.1, 1.0, 10.0, 100.0],
        }
    ],
    "anchors": [{"particles": [0, 1, 2, 3, 4, 5]}],
}
SEEN_BY = {
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
}
"""Linear red, green and blue as such eyes see them (Machado, Oliveira and Fernandes, 2009, severity 1)."""
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def linear(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light of sRGB (n, 3) from 0 to 1 (IEC 61966-2-1)."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def lab(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """CIELAB of linear light (n, 3)."""
    part = light @ XYZ.T / XYZ.sum(axis=1)
    f = np.where(part > 216 / 24389, np.cbrt(part), (24389 / 27 * part + 16) / 116)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)


def stops(studio: Studio) -> NDArray[np.float64]:
    """The colours of the legend (n, 3) from 0 to 1."""
    drawn = studio.page.locator(".ramp").evaluate("(one) => one.style.background")
    return np.array([[float(n) / 255 for n in rgb] for rgb in re.findall(r"rgb\((\d+), (\d+), (\d+)\)", drawn)])


@pytest.mark.parametrize("theme", sampled(["light", "dark"], 2))
def test_scales_are_chosen_and_their_colours_told_apart_by_any_eyes(open_studio: Any, theme: str) -> None:
    """Springs of -10, 0.1, 1, 10 and 100 N. Two colours of the scale differ by at least 10 (CIE 1976), four times what
    is just noticeable (2.3), for every common kind of eyes."""
    studio = open_studio(theme=theme)
    studio.service.put("scales", STRETCHED)
    studio.open("scales")
    page = studio.page
    ends = page.get_by_role("group", name="Legend").locator(".ends")

    def reads(low: str, high: str) -> None:
        page.wait_for_function(
            "([low, high]) => { const all = [...document.querySelectorAll('.legend .ends span')];"
            " return all.length && all[0].innerText === low && all.at(-1).innerText === high }",
            arg=[low, high],
        )

    reads("-100", "100")
    scale = page.get_by_label("Scale of the colours")
    scale.select_option("log")
    reads("0.1", "100")
    assert "Size of force, log" in page.get_by_role("group", name="Legend").inner_text()
    page.get_by_label("From of the colours").fill("1")
    page.keyboard.press("Tab")
    reads("1", "100")
    page.get_by_text("1 value beyond").wait_for()
    scale.select_option("auto")
    page.get_by_label("To of the colours").fill("20")
    page.keyboard.press("Tab")
    reads("-10", "20")
    scale.select_option("even")
    reads("-100", "100")
    page.get_by_label("To of the colours").fill("20")
    page.keyboard.press("Tab")
    reads("-20", "20")
    page.get_by_text("1 value beyond").wait_for()
    page.get_by_label("To of the colours").fill("")
    page.keyboard.press("Tab")
    reads("-100", "100")
    assert ends.count() == 1
    colours = linear(stops(studio))
    for eyes in (np.eye(3), *map(np.array, SEEN_BY.values())):
        seen = lab(np.clip(colours @ eyes.T, 0, 1))
        apart = np.linalg.norm(seen[:, None] - seen[None], axis=2)
        assert apart[np.triu_indices(len(seen), 1)].min() > 10


@pytest.mark.soak
@pytest.mark.parametrize("theme", sampled(["dark", "light"], 2))
def test_a_picked_spring_has_a_dark_and_a_light_line_on_every_colour(open_studio: Any, theme: str) -> None:
    """Across its middle the lightest and darkest pixel have a contrast of 7 at least (WCAG 2.2, 1.4.11 asks for 3)."""
    studio = open_studio(theme=theme)
    studio.service.put("picked-seen", STRETCHED)
    studio.open("picked-seen")
    for spring in range(5):
        studio.page.get_by_label("Spring number").fill(str(spring))
        studio.page.keyboard.press("Enter")
        studio.page.get_by_role("heading", name=f"Spring {spring}").wait_for()
        (ax, ay), (bx, by) = studio.place(spring), studio.place(spring + 1)
        x, y = (ax + bx) / 2, (ay + by) / 2
        box = {"x": x - 1, "y": y - 9, "width": 3, "height": 19}
        pixels = np.array(Image.open(BytesIO(studio.page.screenshot(clip=box))).convert("RGB")) / 255
        light = linear(pixels.reshape(-1, 3)) @ XYZ[1]
        assert (light.max() + 0.05) / (light.min() + 0.05) > 7


@pytest.mark.soak
def test_guides_are_drawn_where_they_are(tab: Studio) -> None:
    """A closed curve, a mesh and a plane that forces pull to: pixels of their colour, none without the layer."""
    scene = net(4)
    corners = [[-2.0, -2.0, 0.0], [5.0, -2.0, 0.0], [5.0, 5.0, 0.0], [-2.0, 5.0, 0.0]]
    roof = {"vertices": [[0, 0, 3], [3, 0, 3], [3, 3, 3], [0, 3, 3]], "faces": [[0, 1, 2, 3]]}
    scene["forces"] += [
        {"kind": "pull_to_curve", "particles": [5], "curve": corners, "closed": True, "strength": 1.0},
        {"kind": "pull_to_mesh", "particles": [6], **roof, "strength": 1.0},
        {"kind": "pull_to_plane", "particles": [9], "origin": [0, 0, -1], "normal": [0, 0, 1], "strength": 1.0},
    ]
    tab.service.put("guides", scene)
    tab.open("guides")
    tab.place(0)
    seen = guide_pixels(tab)
    assert seen > 200
    tab.page.get_by_label("Guides").uncheck()
    tab.until(lambda: guide_pixels(tab) < seen / 20)


def guide_pixels(studio: Studio) -> int:
    """Pixels of the canvas that are brown as guides are (#8a6d1f, partly over the ground); nothing else is."""
    box = studio.page.get_by_label("The form").bounding_box()
    pixels = np.array(Image.open(BytesIO(studio.page.screenshot(clip=box))).convert("RGB")).astype(int)
    return int(((pixels[..., 0] - pixels[..., 2] > 50) & (pixels[..., 1] > pixels[..., 2])).sum())


@pytest.mark.soak
def test_a_form_of_one_force_reads_equal_on_a_symmetric_scale(tab: Studio) -> None:
    """A flat field has no scale, whatever kind was chosen."""
    tab.service.put("even-flat", family("grid", across=2, along=2, load=0).model_dump(mode="json"))
    tab.open("even-flat")
    tab.page.get_by_label("Scale of the colours").select_option("even")
    tab.page.get_by_text("Force: all equal, 0 N").wait_for()
