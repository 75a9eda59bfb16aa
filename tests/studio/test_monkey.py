"""A seeded monkey at the page: hundreds of clicks, keys, drags and numbers; nothing fails and no notice stays."""

from __future__ import annotations

import numpy as np
import pytest

from soak import SOAK

from .browser import Studio

pytestmark = pytest.mark.slow
SCENES = ["9.24-membrane", "basento", "miura", "linkage", "inflation", "hypar-roof"] if SOAK else ["9.24-membrane"]
ACTIONS = 150 if SOAK else 30
KEYS = ["f", "a", "p", " ", ".", "Escape", "x", "Control+z", "Control+Shift+z", "Alt+ArrowUp", "Tab", "ArrowLeft", "+"]
CLICK = """(part) => {
    const controls = document.querySelectorAll("button, summary, input[type=checkbox], input[type=radio]");
    const leaves = /All sessions|Copy link|Save|Export|PNG|CSV|npz|Rhino|OBJ|COMPAS/;
    const open = [...controls].filter((one) => !one.disabled && one.checkVisibility() && !leaves.test(one.textContent));
    const one = open[Math.floor(part * open.length)];
    one?.click();
    return one?.textContent.slice(0, 30) ?? "nothing";
}"""
"""Clicks one of the controls that neither leave the page nor download; all at once, for they come and go."""
FOCUS = """([part, which]) => {
    const open = [...document.querySelectorAll(which)].filter((one) => !one.disabled && one.checkVisibility());
    const one = open[Math.floor(part * open.length)];
    one?.focus();
    one?.select?.();
    return Boolean(one);
}"""


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
        self.done.append("click " + self.page.evaluate(CLICK, self.random.random()))

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
        self.focus("canvas")
        self.done.append(KEYS[int(self.random.integers(len(KEYS)))])
        self.page.keyboard.press(self.done[-1])

    def number(self) -> None:
        if self.focus("input[type=text], input[inputmode=decimal]"):
            told = ["0", "-1", "1e9", "3", "abc", "0.001"][int(self.random.integers(6))]
            self.page.keyboard.type(told)
            self.page.keyboard.press("Enter")
            self.done.append(f"number {told}")

    def slide(self) -> None:
        if self.focus("input[type=range]"):
            self.page.keyboard.press(["PageUp", "PageDown", "ArrowRight"][int(self.random.integers(3))])
            self.done.append("slide")

    def focus(self, which: str) -> bool:
        """Put the focus on one of these, if there are any."""
        return bool(self.page.evaluate(FOCUS, [self.random.random(), which]))


@pytest.mark.soak
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
    monkey.focus("canvas")
    for _ in range(2):
        tab.page.keyboard.press("Escape")
    close = tab.page.get_by_role("button", name="Close the notice")
    tab.until(lambda: not close.count(), what=f"the end of a notice after {monkey.done}")
    assert np.isfinite(tab.particles()).all() and len(tab.particles())
