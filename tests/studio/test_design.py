"""A design problem driven from the page: values, goals and constraints are those that `hookean.design` finds."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hookean
from hookean.files import project

from .browser import Studio
from .tasks import enter, made, opened, rests

PRINTED = 5e-4
"""Relative: the panel prints four digits."""
WITHIN = 1e-5
"""Relative: a search ends at changes of 1e-8, and this one started from another one's values."""


@pytest.fixture
def cable(studio: Studio) -> Studio:
    """A cable of 8 pieces over 10 m, made from an empty page, with the panel of the design open."""
    made(studio, "Cable", Parts="8")
    opened(studio, "Design")
    return studio


def vary(studio: Studio, value: str, **bounds: str) -> None:
    """Let a value of the scene vary, between bounds."""
    page = studio.page
    part = page.get_by_role("region", name="What may vary")
    unfolded(studio, "Add what may vary")
    part.get_by_label("Value", exact=True).select_option(label=value)
    part.get_by_role("button", name="Let it vary").click()
    for seen, bound in bounds.items():
        enter(studio, part.get_by_label(re.compile(f"^{seen.replace('_', ' ')} {value}")), bound)


def ask(studio: Studio, what: str, kind: str, **given: str) -> None:
    """Add a goal or a constraint of a kind, by the labels of its fields."""
    unfolded(studio, f"Add a {what}")
    form = studio.page.get_by_role("form", name=f"New {what}")
    form.get_by_label("Measures").select_option(label=kind)
    for name, value in given.items():
        field = form.get_by_label(re.compile(f"^{name.replace('_', ' ')}( \\[|$)"))
        if field.evaluate("(found) => found.tagName") == "SELECT":
            field.select_option(label=value)
        else:
            enter(studio, field, value)
    form.get_by_role("button", name=f"Add the {what}").click()
    studio.page.get_by_role("group", name=f"{what.capitalize()} {kind}").last.wait_for()


def unfolded(studio: Studio, summary: str) -> None:
    found = studio.page.locator("summary", has_text=summary)
    if not found.evaluate("(one) => one.parentElement.open"):
        found.click()


def told(studio: Studio) -> str:
    """What is reported of the last search, once none runs."""
    studio.page.get_by_role("group", name="Search").wait_for(state="detached")
    best: str = studio.page.get_by_role("region", name="Best values").inner_text()
    return best


def number(text: str, after: str) -> float:
    found = re.search(re.escape(after) + r"[^:]*: (-?\d+(?:\.\d+)?(?:e-?\d+)?)", text)
    assert found, text
    return float(found[1])


@pytest.mark.slow
def test_what_may_vary_is_listed_below_its_heading(cable: Studio):
    """In the whole width of the panel, as near to the heading as the next entry is to the first (8 px)."""
    vary(cable, "cable rest factor")
    part = cable.page.get_by_role("region", name="What may vary")
    head, entry, all_ = (
        one.bounding_box() for one in (part.get_by_role("heading"), part.get_by_role("group").first, part)
    )
    assert head and entry and all_
    assert entry["y"] - (head["y"] + head["height"]) == pytest.approx(8, abs=1)
    assert (entry["x"], entry["width"]) == pytest.approx((all_["x"], all_["width"]), abs=1)


def test_a_sag_is_asked_for_by_slider_and_its_values_are_used(cable: Studio):
    """The rest factor for a sag: the panel reports what Python finds and follows the slider; one Undo takes it back."""
    page, service, key = cable.page, cable.service, cable.key
    vary(cable, "cable rest factor", At_least="0.5", At_most="1.5")
    ask(cable, "goal", "Position", Particles="4", Axes="z")
    scene = service.scene(key)
    present = hookean.relax(hookean.Scene.read(scene)).particles[4, 2]
    target = page.get_by_role("spinbutton", name=re.compile("^Target of Position"))
    assert float(target.input_value()) == pytest.approx(present, rel=1e-3)
    cable.press("Search")
    told(cable)

    slider = page.get_by_role("slider", name=re.compile("^Target of Position"))
    slider.focus()
    for _ in range(4):  # each stroke is another problem; the last one is searched to its end
        page.keyboard.press("ArrowLeft")
    wanted = float(target.input_value())
    assert wanted < present
    cable.until(lambda: number(told(cable), "Position of particle 4") == pytest.approx(wanted, rel=PRINTED))
    problem: dict[str, Any] = {
        "scene": scene,
        "variables": [{"force": "cable", "field": "rest_factor", "tie": "all", "lower": 0.5, "upper": 1.5}],
        "goals": [{"kind": "position", "particles": [4], "axes": "z", "target": wanted}],
    }
    truth = hookean.design(problem)
    best = told(cable)
    assert "Met." in best
    assert number(best, "cable rest factor") == pytest.approx(truth.variables[0]["value"], rel=PRINTED)
    page.get_by_role("group", name="Legend").get_by_text("Best values").wait_for()

    cable.press("Use these values")
    cable.until(lambda: rests(cable))
    assert service.scene(key)["forces"][0]["rest_factor"] == pytest.approx(truth.variables[0]["value"], rel=WITHIN)
    assert service.particles(key)[4, 2] == pytest.approx(wanted, rel=WITHIN)
    cable.rests_at(service.particles(key))
    assert service.summary(key)["undo"] == 1
    cable.press("Undo")
    cable.until(lambda: service.scene(key)["forces"] == scene["forces"])


@pytest.mark.soak
def test_conflicts_bounds_and_constraints_are_reported_in_words(cable: Studio):
    """Two sags of one particle conflict; a limit of the force that no rest factor in the bounds keeps is not met."""
    page, service, key = cable.page, cable.service, cable.key
    vary(cable, "cable rest factor", At_least="0.9", At_most="1.1")
    position = {"kind": "position", "particles": [4], "axes": "z"}
    for place, target in enumerate(("-1.4", "-1.8")):
        ask(cable, "goal", "Position", Particles="4", Axes="z")
        enter(cable, page.get_by_role("spinbutton", name=re.compile("^Target of Position")).nth(place), target)
    cable.press("Search")
    best = told(cable)
    problem: dict[str, Any] = {
        "scene": service.scene(key),
        "variables": [{"force": "cable", "field": "rest_factor", "tie": "all", "lower": 0.9, "upper": 1.1}],
        "goals": [{**position, "name": name, "target": aim} for name, aim in (("high", -1.4), ("low", -1.8))],
    }
    truth = hookean.design(problem)
    assert truth.goals[0]["conflicts"] == ["low"] and "It conflicts with Position of particle 4, z 2." in best
    assert number(best, "cable rest factor") == pytest.approx(truth.variables[0]["value"], rel=PRINTED)

    ask(cable, "constraint", "Force", Force="cable", At_most="1")  # the search follows what is added
    page.get_by_text("The constraint is not met.").wait_for()
    best = told(cable)
    truth = hookean.design({**problem, "constraints": [{"kind": "force", "force": "cable", "upper": 1.0}]})
    assert truth.status == "infeasible" and "The constraints cannot all be met." in best
    assert np.any(truth.variables[0]["at_bound"]) and "at its bound" in best
    assert number(best, "cable rest factor") == pytest.approx(truth.variables[0]["value"], rel=PRINTED)


@pytest.mark.soak
def test_a_problem_is_saved_with_the_model_and_opened_again(cable: Studio, tmp_path: Path):
    """The file has it; a browser that kept nothing shows it with the model of the file."""
    page = cable.page
    vary(cable, "cable rest factor", At_least="0.5", At_most="1.5")
    ask(cable, "goal", "Position", Particles="4", Axes="z")
    opened(cable, "Save and export")
    with page.expect_download() as saved:
        cable.press("Save")
    file = tmp_path / "cable.hookean"
    saved.value.save_as(file)
    [variable] = project.read(file.read_bytes()).view["design"]["variables"]
    assert (variable["field"], variable["lower"], variable["upper"]) == ("rest_factor", 0.5, 1.5)
    page.evaluate("() => localStorage.clear()")
    page.get_by_role("link", name="All sessions").click()
    page.locator("input[type=file]").set_input_files(file)
    cable.drawing()
    opened(cable, "Design")
    page.get_by_role("group", name="Goal Position").wait_for()
    lower = page.get_by_role("region", name="What may vary").get_by_label(re.compile("^At least cable rest factor"))
    assert float(lower.input_value()) == 0.5
