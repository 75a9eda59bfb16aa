"""The report of a scene: its numbers are those of the results, and it needs nothing but itself."""

from __future__ import annotations

import base64
import io
import re
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest
from PIL import Image

import hookean
from hookean import Scene
from hookean.files.limits import read_limits
from hookean.files.report import report


class Tables(HTMLParser):
    """The headings, the rows of cells below each, and the pictures of a page; tags must nest."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: dict[str, list[list[str]]] = {}
        self.pictures: list[str] = []
        self.text = ""
        self.heading = ""
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[Any]) -> None:
        if tag == "img":
            self.pictures.append(dict(attrs)["src"])
        if tag not in ("img", "meta"):
            self.open.append(tag)
        self.text = ""
        if tag == "tr":
            self.rows.setdefault(self.heading, []).append([])

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag
        if tag in ("h1", "h2"):
            self.heading = self.text
        if tag in ("td", "th"):
            self.rows[self.heading][-1].append(self.text)
        self.text = ""


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A cable <with a name that needs escaping> under snow and its weight."""
    return Scene.read(
        {
            "particles": [[0, 0, 0], [2, 0, 0], [4, 0, 0]],
            "forces": [
                {"kind": "constant_tension", "name": "cable <1>", "particles": [[0, 1], [1, 2]], "tension": 30},
                {"kind": "unary", "name": "snow load", "particles": [1], "vector": [0, 0, -10]},
                {"kind": "self_weight", "name": "weight", "particles": [0, 1, 2], "total": 0.3},
            ],
            "anchors": [{"particles": [0, 2]}],
            "load_cases": {"snow": {"forces": ["snow load"]}},
            "combinations": {"ULS 1": {"snow": 1.5, "prestress": 1.35, "permanent": 1.1}},
            "stages": {"freeze": {"cable <1>": {"axial_stiffness": 2000}}},
        }
    )


def test_the_numbers_are_those_of_the_results(scene: Scene) -> None:
    text = report(scene, title="A & B", pictures=False)
    found = Tables(text)
    assert "<title>A &amp; B</title>" in text
    cases = hookean.load_cases(scene)
    rows = {row[0]: row for row in found.rows["Load cases and combinations"]}
    for name, case in cases.cases.items():
        far = float(np.linalg.norm(case.displacements, axis=1).max())
        assert rows[name][1:5] == ["converged", "stable", f"{far:.5g}", "1"]
    maxima = found.rows["Maxima of all cases, and where they are"]
    largest = float(cases.cases["ULS 1"].result.force("cable <1>")["force"].max())
    assert ["cable <1> force", "largest", f"{largest:.5g}", "ULS 1", "N"] in [row[:5] for row in maxima]
    assert len(found.rows["Largest reactions of all cases"]) == 3
    loads = {row[0]: row for row in reversed(found.rows["Case ULS 1"])}  # the first table has the loads
    assert loads["snow load"][3] == "0, 0, -15" and loads["weight"][3] == "0, 0, -0.33"
    assert loads["together"][3] == "0, 0, -15.33"


@pytest.mark.slow
def test_it_is_one_file_that_is_always_the_same(scene: Scene) -> None:
    """With a PNG for the form and for each case, and no address of another file."""
    text = report(scene)
    assert text == report(scene)
    found = Tables(text)
    assert len(found.pictures) == 3
    for source in found.pictures:
        data = base64.b64decode(source.removeprefix("data:image/png;base64,"))
        assert Image.open(io.BytesIO(data)).size == (1000, 750)
    assert not re.search(r"https?://|<script|<link", text)


def test_limits_are_checked_in_each_case(scene: Scene) -> None:
    limits = read_limits("max_displacement = 0.24\n")
    text = report(scene, limits=limits, pictures=False)
    assert text.count("All limits are met") == 1 and text.count('class="failed"') == 1
    assert "max displacement" in text


def test_a_scene_without_cases_is_relaxed(scene: Scene) -> None:
    plain = scene.model_copy(update={"load_cases": {}, "combinations": {}, "stages": None})
    text = report(plain, limits=read_limits("max_force = 1\n"), pictures=False)
    assert "Load cases" not in text and "max force" in text


def test_a_report_of_beams_has_the_moments_of_loads_and_supports() -> None:
    """A cantilever of 1 m under 2 N down and a moment of 3 N m at its end: at the clamp the moment is 2 L + 3."""
    beam = {"kind": "beam", "name": "b", "particles": [[0, 1]], "E": 1e9, "G": 4e8, "A": 0.1, "Iy": 1e-3, "Iz": 1e-3,
            "J": 1e-3}  # fmt: skip
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [
            beam,
            {"kind": "unary", "name": "P", "particles": [1], "vector": [0, 0, -2], "moment": [0, 3, 0]},
            {"kind": "unary", "name": "pair", "particles": [0, 1], "vector": [[0, 0, -1], [0, 0, -3]]},
        ],
        "anchors": [{"name": "foot", "particles": [0], "rotations": "xyz"}],
        "load_cases": {"P": {"forces": ["P"]}, "pair": {"forces": ["pair"]}},
    }
    text = report(Scene.read(scene), limits=read_limits("max_displacement = 1\n"), pictures=False)
    rows = Tables(text).rows
    load = next(row for row in rows["Case P"] if row[0] == "P")
    assert load[2:4] == ["1", "0, 0, -2"] and load[5] == "0, 3, 0"
    load = next(row for row in rows["Case pair"] if row[0] == "pair")
    assert load[2:4] == ["2", "0, 0, -4"] and load[4].startswith("0.75, 0, ")  # (0 x 1 + 1 x 3) / 4
    _, support = rows["Largest reactions of all cases"]
    assert float(support[2]) == pytest.approx(4.0) and float(support[4]) == pytest.approx(5.0)
    clamp = next(row for row in rows["Case P"] if row[:3] == ["foot", "0", "0, 0, 0"])
    force, moment = ([float(part) for part in cell.split(",")] for cell in clamp[3:])
    assert force == pytest.approx([0, 0, 2], abs=1e-6) and moment == pytest.approx([0, -5.0, 0], abs=1e-6)
    assert text.count("Reactions together: 0, 0, 4 N.") == 1 and "<h3>Reactions</h3>" in text.split("Case P")[0]


def test_a_report_has_what_floors_carry() -> None:
    """Reactions and forces of floors balance the loads: a spring of 10 x 0.15 = 1.5 N lifts at 4 N on a floor,
    which carries 2.5 N; a result at a prompt has both lines."""
    scene = Scene.read({
        "particles": [[0, 0, 0], [0, 0, 2]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 10, "rest_length": 1.85},
            {"kind": "unary", "particles": [0], "vector": [0, 0, -4]},
            {"kind": "floor"},
        ],
        "anchors": [{"name": "top", "particles": [1]}],
    })  # fmt: skip
    text = report(scene, pictures=False)
    assert "<p>Reactions together: 0, 0, 1.5 N.</p>\n<p>Forces of floors together: 0, 0, 2.5 N.</p>" in text
    lines = hookean.relax(scene).summary()
    assert lines[-2:] == [
        "1 reactions: largest 1.5 N, together (0, 0, 1.5) N",
        "1 contacts with floors: largest 2.5 N, together (0, 0, 2.5) N",
    ]


def test_a_report_has_no_negative_zero_and_no_moment_that_is_rounding() -> None:
    """A frame under a weight that is symmetric: its moment about its centre is zero, and zeros have no sign."""
    tube = {"E": 1e6, "G": 4e5, "A": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}
    scene = Scene.read({
        "particles": [[0.1, 0, 0], [0.1, 0, 3.1], [4.2, 0, 3.1], [4.2, 0, 0]],
        "forces": [
            {"kind": "beam", "name": "frame", "particles": [[0, 1], [1, 2], [2, 3]], **tube},
            {"kind": "unary", "name": "snow", "particles": [1, 2], "vector": [0, 0, -0.7]},
        ],
        "anchors": [{"particles": [0, 3], "rotations": "xyz"}, {"particles": [1, 2], "axes": "y"}],
    })  # fmt: skip
    text = report(scene, pictures=False)
    found = hookean.relax(scene)
    assert np.signbit(np.asarray(found.reactions["force"])[found.reactions["force"] == 0.0]).any()
    assert ">-0<" not in text and "-0, " not in text and ", -0<" not in text
    load = next(row for row in Tables(text).rows["Form"] if row[0] == "snow")
    assert load[5] == "0, 0, 0"
