"""Tables of springs, particles and reactions, their histogram, and what is said about a shape at rest."""

from __future__ import annotations

import csv
import re

import numpy as np
import pytest

from serving import CABLE

from .browser import Studio


@pytest.fixture
def cable(tab: Studio) -> Studio:
    """A cable at rest whose springs have a strength, with the panel of tables open."""
    springs = {**CABLE["forces"][0], "strength": 200.0}
    scene = {**CABLE, "forces": [springs, CABLE["forces"][1]]}
    tab.service.put("tables", scene)
    tab.service.act("tables", "relax")
    tab.service.at_rest("tables")
    tab.open("tables")
    tab.page.locator("summary", has_text="Tables").click()
    return tab


@pytest.mark.soak
def test_springs_are_sorted_selected_and_saved(cable: Studio):
    """Order, values and units are those of the Python API (float32 frames: 1e-6 relative); a bar of the histogram
    leaves its springs in the table; CSV has all rows in their order."""
    page = cable.page
    state = cable.service.state("tables")
    forces = np.array(state["forces"][0]["force"])
    page.get_by_role("columnheader", name="Utilisation").wait_for()
    page.get_by_role("columnheader", name="Force").get_by_role("button").click()
    rows = page.get_by_role("region", name="Table of springs").locator("tbody tr")
    first = rows.first.locator("td").first
    cable.until(lambda: float(first.inner_text()) == pytest.approx(forces.max(), rel=1e-3))
    with page.expect_download() as saving:
        page.get_by_role("button", name="Save rows").click()
    head, *told = list(csv.reader(saving.value.path().read_text().splitlines()))
    assert head == ["spring", "force [N]", "length [m]", "strain [%]", "utilisation [%]"]
    assert max(len(row[1].lstrip("-0.").replace(".", "")) for row in told) <= 9  # no digits that a float32 has not
    numbers = np.array(told, float)
    assert (np.diff(numbers[:, 1]) <= 0).all()
    by_number = numbers[np.argsort(numbers[:, 0])]
    assert by_number[:, 1] == pytest.approx(forces, rel=1e-6)
    assert by_number[:, 3] == pytest.approx(100 * np.array(state["forces"][0]["strain"]), rel=1e-9)
    assert by_number[:, 4] == pytest.approx(100 * np.array(state["forces"][0]["utilisation"]), rel=1e-9)

    bars = page.get_by_role("group", name="Histogram of force").get_by_role("button")
    bars.last.click()
    most = int(np.sum(forces >= forces.min() + 11 / 12 * np.ptp(forces)))
    cable.until(lambda: rows.count() == most < len(forces))
    rows.first.get_by_role("button").click()
    page.get_by_role("heading", name=re.compile("Spring [04]")).wait_for()


def test_reactions_are_summed(cable: Studio):
    """Equilibrium: the reactions together are minus the loads, 6 x 20 N; forces along x cancel, to 0. A
    float32 frame of numbers below 256 N is exact to 2^-17 N each. Before anything is sorted their sizes are counted:
    the two ends bear the same."""
    cable.page.get_by_role("button", name="Reactions", exact=True).click()
    sums = cable.page.locator("tfoot td").all_inner_texts
    cable.until(lambda: len(sums()) == 4)
    x, _, z, size = sums()
    assert x == "0" and float(z) == pytest.approx(120, abs=1e-3) and size == ""
    bars = cable.page.get_by_role("group", name="Histogram of size").get_by_role("button")
    held = cable.until(lambda: [int(bar.get_attribute("aria-label").split()[0]) for bar in bars.all()])
    assert sum(held) == 2


def test_stability_and_accuracy_are_at_the_status(cable: Studio):
    """The word and the number are those of the result of the service."""
    told = cable.page.get_by_label("Status").locator(".stability")
    told.wait_for()
    state = cable.service.state("tables")
    assert state["stability"] == "stable" and told.inner_text().startswith("Stability: stable.")
    within = re.search(r"within (\S+) m of the equilibrium", told.inner_text())
    assert within and float(within[1]) == pytest.approx(state["position_error"], rel=0.05)


@pytest.mark.soak
def test_a_drag_is_told_at_the_hand(cable: Studio):
    """Position, distance and reaction of the particle that is dragged are those of the service; afterwards they go."""
    page, service = cable.page, cable.service
    before = service.particles("tables")[2]
    x, y = cable.place(2)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 15, y + 40, steps=6)
    told = page.get_by_role("group", name="At the hand")
    told.get_by_text("Reaction").wait_for()

    def fits() -> bool:
        state = service.state("tables")
        at, held = np.array(state["particles"])[2], state["reactions"]
        if state["status"] != "converged" or 2 not in held["particles"]:
            return False
        reaction = np.linalg.norm(held["force"][held["particles"].index(2)])
        seen = [float(number) for number in re.findall(r"-?[\d.]+(?:e-?\d+)?", told.inner_text())]
        wanted = [*at, np.linalg.norm(at - before), reaction]
        return bool(np.allclose(seen, wanted, rtol=1e-3, atol=1e-6))

    cable.until(fits)
    page.mouse.up()
    told.wait_for(state="detached")


@pytest.mark.soak
def test_springs_without_a_rest_length_have_no_strain(tab: Studio):
    """(l - L0) / L0 is undefined for L0 = 0: the table of a force-density net has no such column."""
    net = {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 10, "rest_factor": 0}
    tab.service.put(
        "tables-dense",
        {"particles": [[0, 0, 0], [1, 0, 0], [3, 0, 0]], "forces": [net], "anchors": [{"particles": [0, 2]}]},
    )
    tab.open("tables-dense")
    tab.press("Solve")
    tab.service.at_rest("tables-dense")
    tab.page.locator("summary", has_text="Tables").click()
    tab.page.get_by_label("Status").locator(".stability").wait_for()  # the whole result is read
    head = tab.page.get_by_role("region", name="Table of springs").get_by_role("columnheader")
    tab.until(lambda: head.count() > 0)
    assert [text.split()[0] for text in head.all_inner_texts()] == ["Spring", "Force", "Length"]
