"""Readable and reachable: sizes, overlaps and contrast in both themes on laptop and phone, and keys for all of it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from serving import CABLE
from soak import sampled

from .browser import LAPTOP, PHONE, Studio
from .conftest import Opened
from .service import equilibrium

AXE = Path(__file__).parents[2] / "studio" / "node_modules" / "axe-core" / "axe.min.js"
LEAST = 11
"""CSS pixels of the smallest text."""
EYES = [(LAPTOP, "light"), (LAPTOP, "dark"), (PHONE, "light"), (PHONE, "dark")]

SMALL = """(least) => [...document.querySelectorAll("body *")].filter((one) => {
    const words = [...one.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
    return words && one.checkVisibility() && parseFloat(getComputedStyle(one).fontSize) < least;
}).map((one) => one.outerHTML.slice(0, 120))"""

COVERED = """() => {
    const found = [];
    const controls = "button, a[href], input, select, summary, [role=button], [tabindex='0']:not(canvas)";
    for (const one of document.querySelectorAll(controls)) {
        if (!one.checkVisibility({ visibilityProperty: true }) || one.closest(".unseen, .skip")) continue;
        one.scrollIntoView({ block: "center", inline: "nearest" });
        const box = one.getBoundingClientRect();
        if (box.width < 1 || box.height < 1) continue;
        const hit = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
        if (!hit || !(one.contains(hit) || hit.contains(one) && hit.matches("label")))
            found.push([one.outerHTML.slice(0, 90), hit?.outerHTML.slice(0, 90)]);
    }
    scrollTo(0, 0);
    return found;
}"""
"""Controls that cannot be clicked in their middle, and what covers them."""

CROSSED = """() => {
    const leaves = [...document.querySelectorAll("body *")].filter((one) =>
        one.checkVisibility({ visibilityProperty: true }) && !one.closest(".unseen, .skip, svg, option, dialog") &&
        [...one.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim()));
    const seen = ([l, t, r, b], one) => {
        for (let around = one; around && around !== document.body; around = around.parentElement) {
            if (getComputedStyle(around).overflow === "visible") continue;
            const clip = around.getBoundingClientRect();
            [l, t] = [Math.max(l, clip.left), Math.max(t, clip.top)];
            [r, b] = [Math.min(r, clip.right), Math.min(b, clip.bottom)];
        }
        return [l, t, r, b];
    };
    const boxes = leaves.map((one) => {
        const range = document.createRange();
        range.selectNodeContents(one);
        return [...range.getClientRects()].map((box) => seen([box.left, box.top, box.right, box.bottom], one));
    });
    const within = (one, clip) => one.closest(clip);
    const found = [];
    for (let i = 0; i < leaves.length; i++)
        for (let j = i + 1; j < leaves.length; j++) {
            if (leaves[i].contains(leaves[j]) || leaves[j].contains(leaves[i])) continue;
            if (within(leaves[i], ".panels") !== within(leaves[j], ".panels")) continue;
            for (const [l, t, r, b] of boxes[i])
                for (const [m, u, s, c] of boxes[j])
                    if (Math.min(r, s) - Math.max(l, m) > 2 && Math.min(b, c) - Math.max(t, u) > 3)
                        found.push([leaves[i].textContent.slice(0, 60), leaves[j].textContent.slice(0, 60)]);
        }
    return found;
}"""
"""Words that are written over other words, where neither is scrolled away."""

STACKED = """() => {
    const over = [...document.querySelectorAll(".stage > *:not(canvas)")]
        .filter((one) => one.checkVisibility()).map((one) => [one.className, one.getBoundingClientRect()])
        .filter(([, box]) => box.width > 1 && box.height > 1);
    return over.flatMap(([name, a], i) => over.slice(i + 1).filter(([, b]) =>
        Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
        Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1).map(([other]) => [name, other]));
}"""
"""Boxes over the canvas that overlap each other."""


def shown(open_studio: Opened, where: str, size: dict[str, int], theme: str) -> Studio:
    """The start page with more sessions than it has room for, or a session in which all panels are open, something is
    picked and something warned of."""
    studio = open_studio(size, theme)
    if where == "start":
        for number in range(9):
            studio.service.put(f"listed{number}", CABLE)
        studio.start()
        studio.page.get_by_text("listed8").wait_for()
        studio.page.get_by_role("heading", name="Figures").wait_for()
        studio.page.locator("img").first.wait_for()
        return studio
    service = studio.service
    service.put("readable", {**CABLE, "strict": False, "anchors": [*CABLE["anchors"], {"points": [[99, 0, 0]]}]})
    service.act("readable", "play?fast=true")
    service.at_rest("readable")
    studio.open("readable")
    closed = studio.page.locator("details:not([open]) > summary")
    while closed.count():  # the first of them is in sight: those around it are open
        closed.first.click()
    studio.page.get_by_label("Particle number").fill("0")
    studio.page.keyboard.press("Enter")
    studio.page.get_by_role("heading", name="Particle 0").wait_for()
    return studio


@pytest.mark.thinned
@pytest.mark.parametrize("eyes", sampled([(where, *eyes) for eyes in EYES for where in ("session", "start")], 3))
def test_all_is_legible_and_nothing_overlaps(open_studio: Opened, eyes: tuple[str, dict[str, int], str]):
    """No text below 11 px or over other text, no control covered, no scrolling sideways; axe finds nothing serious."""
    where, size, theme = eyes
    studio = shown(open_studio, where, size, theme)
    page = studio.page
    ground = page.evaluate("() => getComputedStyle(document.documentElement).backgroundColor")
    dark = [int(part) for part in re.findall(r"\d+", ground)[:3]]
    assert (sum(dark) < 384) == (theme == "dark")
    widths = "() => [document.documentElement, document.querySelector('.shown')].map((one) => one.scrollWidth)"
    assert max(page.evaluate(widths)) <= size["width"]
    assert page.evaluate(SMALL, LEAST) == []
    assert page.evaluate(CROSSED) == []
    assert page.evaluate(STACKED) == []
    assert page.evaluate(COVERED) == []
    assert serious(studio) == []


def serious(studio: Studio) -> list[Any]:
    """What axe finds that is serious or critical."""
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: python hatch_build.py check")
    studio.page.evaluate(AXE.read_text())
    found = studio.page.evaluate("() => axe.run(document, { resultTypes: ['violations'] })")["violations"]
    return [
        (one["id"], one["impact"], [(node["html"][:120], node["failureSummary"][:200]) for node in one["nodes"][:3]])
        for one in found
        if one["impact"] in ("serious", "critical")
    ]


# by keyboard alone

REACHED = """() => {
    const one = document.activeElement;
    if (!one || one === document.body) return null;
    const style = getComputedStyle(one);
    const outlined = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 0;
    one.dataset.reached = "yes";
    return { outlined: outlined || style.boxShadow !== "none", html: one.outerHTML.slice(0, 100) };
}"""
LEFT = """() => [...document.querySelectorAll("button, a[href], input, select, summary, canvas")]
    .filter((one) => one.checkVisibility() && !one.disabled && one.tabIndex >= 0 && !one.dataset.reached)
    .filter((one) => one.type !== "radio" || !document.querySelector(`[name="${one.name}"][data-reached]`))
    .map((one) => one.outerHTML.slice(0, 100))"""


@pytest.mark.soak
@pytest.mark.parametrize("where", sampled(["session", "start"], 2))
def test_every_control_is_reached_by_tab_and_seen_to_be(open_studio: Opened, where: str):
    studio = shown(open_studio, where, LAPTOP, "light")
    page = studio.page
    page.evaluate("() => { document.activeElement?.blur(); getSelection().removeAllRanges(); scrollTo(0, 0); }")
    plain = []
    for _ in range(300):  # more than there are controls
        page.keyboard.press("Tab")
        reached = page.evaluate(REACHED)
        if reached and not reached["outlined"]:
            plain.append(reached["html"])
        if not page.evaluate(LEFT):
            break
    assert page.evaluate(LEFT) == []
    assert plain == []


def test_a_cable_is_opened_formed_and_edited_by_keyboard_alone(studio: Studio):
    """From the gallery to equilibrium, an anchor moved, undone: no mouse."""
    page, service = studio.page, studio.service
    figure = next(e for e in service.client.get("/v1/examples").json()["examples"] if e["id"] == "9.4-cable")
    page.get_by_role("button", name=f"{figure['figure']} {figure['title']}").focus()
    page.keyboard.press("Enter")
    studio.drawing()
    key = studio.key
    page.get_by_role("button", name="Solve").focus()
    page.keyboard.press("Enter")
    truth = equilibrium(service.example("9.4-cable"))
    studio.rests_at(truth)

    page.locator("canvas").first.focus()
    ends = service.anchors(key)
    page.keyboard.press("a")
    page.keyboard.press("Alt+ArrowRight")
    studio.until(lambda: service.anchors(key) != ends)
    page.keyboard.press("Control+z")
    studio.until(lambda: service.anchors(key) == ends)
    studio.until(lambda: service.summary(key)["redo"] >= 1)
    page.keyboard.press("Control+Shift+z")
    studio.until(lambda: service.anchors(key) != ends)

    load = page.get_by_role("slider", name="Size of load")
    load.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    heavier = studio.until(lambda: (now := service.scene(key)["forces"][1]["vector"]) != [0, 0, -10] and now)
    assert heavier[2] < -10
    page.keyboard.press("Escape")
    page.locator("canvas").first.focus()
    playing = service.summary(key)["playing"]
    page.keyboard.press(" ")
    studio.until(lambda: service.summary(key)["playing"] is not playing)
    page.keyboard.press("?")
    page.get_by_role("dialog", name="Keys").wait_for()
    page.keyboard.press("Escape")
    page.get_by_role("dialog", name="Keys").wait_for(state="hidden")
