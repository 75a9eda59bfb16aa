"""A seeded monkey at the page: hundreds of clicks, keys, drags and numbers; nothing fails and no notice stays."""

from __future__ import annotations

import numpy as np
import pytest

from soak import SOAK

from .browser import Studio

pytestmark = pytest.mark.slow
SCENES = ["9.24-membrane", "basento", "miura", "linkage", "inflation", "hypar-roof"] if SOAK else ["9.24-membrane"]
ACTIONS = 150 if SOAK else 60
KEYS = ["f", "a", "p", " ", ".", "Escape", "x", "Control+z", "Control+Shift+z", "Alt+ArrowUp", "Tab", "ArrowLeft", "+"]
LEAVES = {"All sessions", "Copy link", "Save", "PNG", "CSV", "npz"}
"""Buttons that leave the page, or that download."""
CONTROLS = "button:visible:enabled, summary:visible, input[type=checkbox]:visible, input[type=radio]:visible"


class Monkey:
    """Acts at random on a page."""

    def __init__(self, studio: Studio, seed: int) -> None:
        self.page, self.random = studio.page, np.random.default_rng(seed)
        self.done: list[str] = []

    def act(self) -> None:
        """One action, drawn by its weight."""
        acts = [self.click, self.drag, self.key, self.number, self.slide]
        acts[int(self.random.choice(len(acts), p=[0.45, 0.2, 0.2, 0.1, 0.05]))]()

    def click(self) -> None:
        controls = [one for one in self.page.locator(CONTROLS).all() if not self._leaves(one.inner_text())]
        if controls:
            one = controls[int(self.random.integers(len(controls)))]
            self.done.append(f"click {one.inner_text()[:30]}")
            one.evaluate("(control) => control.click()")

    def drag(self) -> None:
        box = self.page.locator("canvas").first.bounding_box()
        assert box is not None
        x, y, across, down = self.random.random(4)
        self.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
        self.page.mouse.down()
        self.page.mouse.move(box["x"] + across * box["width"], box["y"] + down * box["height"], steps=3)
        self.page.mouse.up()
        self.done.append("drag")

    def key(self) -> None:
        self.page.locator("canvas").first.focus()
        self.done.append(KEYS[int(self.random.integers(len(KEYS)))])
        self.page.keyboard.press(self.done[-1])

    def number(self) -> None:
        fields = self.page.locator("input[type=text]:visible:enabled, input[inputmode=decimal]:visible:enabled").all()
        if fields:
            told = ["0", "-1", "1e9", "3", "abc", "", "0.001"][int(self.random.integers(7))]
            fields[int(self.random.integers(len(fields)))].fill(told)
            self.page.keyboard.press("Enter")
            self.done.append(f"number {told}")

    def slide(self) -> None:
        sliders = self.page.locator("input[type=range]:visible:enabled").all()
        if sliders:
            sliders[int(self.random.integers(len(sliders)))].focus()
            self.page.keyboard.press(["PageUp", "PageDown", "ArrowRight"][int(self.random.integers(3))])
            self.done.append("slide")

    @staticmethod
    def _leaves(text: str) -> bool:
        return text.strip() in LEAVES or any(word in text for word in ("Save", "Export", "Rhino", "OBJ", "COMPAS"))


@pytest.mark.parametrize("scene", SCENES)
def test_whatever_is_done_no_exception_and_no_notice_stays(tab: Studio, scene: str) -> None:
    """Refused edits are expected, by 4xx answers; exceptions in the page and answers of 5xx are not. After two Escapes
    no notice is left, and the form is still drawn."""
    tab.allowed += [r"^4\d\d: ", r"console error: Failed to load resource.* 4\d\d"]
    tab.page.on("dialog", lambda dialog: dialog.dismiss())
    tab.service.put("monkey", tab.service.example(scene))
    tab.open("monkey")
    monkey = Monkey(tab, seed=SCENES.index(scene))
    for _ in range(ACTIONS):
        monkey.act()
        assert not tab.unexpected(), monkey.done
        if "#s=" not in tab.page.url:
            tab.open("monkey")
    tab.service.act("monkey", "pause")
    tab.page.locator("canvas").first.focus()
    for _ in range(2):
        tab.page.keyboard.press("Escape")
    close = tab.page.get_by_role("button", name="Close the notice")
    tab.until(lambda: not close.count(), what=f"the end of a notice after {monkey.done}")
    assert np.isfinite(tab.particles()).all() and len(tab.particles())
