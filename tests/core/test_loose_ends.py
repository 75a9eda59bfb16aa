"""Loose ends: lines of one force that miss a node by a little are reported, and nothing else is."""

from __future__ import annotations

from typing import Any

import pytest

from hookean import Scene
from hookean.system.system import compile


def found(*lines: Any, anchors: Any = (), more: Any = ()) -> list[str]:
    springs = {"kind": "springs", "name": "net", "lines": list(lines)}
    held = [{"points": list(anchors)}] if anchors else []
    return compile(Scene.read({"forces": [springs, *more], "anchors": held, "units": {"length": "ft"}})).report.warnings


BEAM = [[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]
SAID = (
    "net: 1 of 1 loose ends lie on other lines of this force, within a tenth of their length, but are not joined to "
    "them; the first is particle {}, {} ft away. Draw lines from node to node, or raise weld_tolerance"
)
ENDS = [0, 0, 0], [2, 0, 0]


@pytest.mark.parametrize("gap", [0.0011, 0.01, 0.09])
def test_a_line_that_misses_its_node(gap: float) -> None:
    """By more than the weld tolerance of 0.001 and less than a tenth of the lines' length of 1."""
    top = [1, 1 + gap, 0]
    assert found(*BEAM, [[1, gap, 0], top], anchors=[*ENDS, top]) == [SAID.format(f"3 at (1, {gap}, 0)", gap)]


def test_lines_of_given_particles_are_joined_by_a_particle() -> None:
    """No tolerance welds particles that are given: 1 and 2 are 1e-9 ft apart, and stay two."""
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0], [1 + 1e-9, 0, 0], [2, 0, 0]],
        "forces": [{"kind": "springs", "name": "net", "particles": [[0, 1], [2, 3]]}],
        "anchors": [{"particles": [0, 3]}],
    }
    (said,) = compile(Scene.read(scene)).report.warnings
    assert said.endswith("Draw lines from node to node, or give both lines the same particle")


def test_a_line_that_ends_between_two_nodes() -> None:
    """A T drawn without a node: the end lies on the line, at distance 0."""
    assert found(*BEAM, [[0.5, 0, 0], [0.5, 1, 0]], anchors=[*ENDS, [0.5, 1, 0]]) == [
        SAID.format("3 at (0.5, 0, 0)", 0)
    ]


def test_the_shorter_of_the_two_lines_counts() -> None:
    """0.05 is a twentieth of the beam's lines and a fifth of the short one."""
    assert found(*BEAM, [[1, 0.05, 0], [1, 0.3, 0]], anchors=[*ENDS, [1, 0.3, 0]]) == []


def test_what_is_joined_held_or_far_away_is_none() -> None:
    """A node that is met; a gap of a fifth; an end that an anchor holds; one that goes on in another force; a hair from
    a node along the line that starts there; a chain whose end hangs free."""
    up = [[1, 0.05, 0], [1, 1, 0]]
    assert found(*BEAM, [[1, 0, 0], [1, 1, 0]], anchors=[*ENDS, up[1]]) == []
    assert found(*BEAM, [[1, 0.2, 0], [1, 1.2, 0]], anchors=[*ENDS, [1, 1.2, 0]]) == []
    assert found(*BEAM, up, anchors=[*ENDS, *up]) == []
    other = {"kind": "springs", "name": "other", "lines": [[up[0], [1, 0.05, 1]]]}
    assert [said for said in found(*BEAM, up, anchors=[*ENDS, up[1]], more=[other]) if "loose" in said] == []
    assert found(*BEAM, [[1, 0, 0], [1.9, 0.01, 0]], anchors=ENDS) == []
    assert found(*BEAM, anchors=ENDS[:1]) == []


def test_strings_side_by_side_are_none() -> None:
    """Their free ends are 1/25 of their length apart; an end that is as far beyond a line is a loose one."""
    strings = [[[0.04 * i, 0, 0], [0.04 * i, 0, -1]] for i in range(4)]
    assert found(*strings, anchors=[top for top, _ in strings]) == []
    beyond = [[1, -0.04, 0], [1, 0.96, 0]]
    assert found([[0, 0, 0], [2, 0, 0]], beyond, anchors=[*ENDS, beyond[1]]) == [
        SAID.format("2 at (1, -0.04, 0)", 0.04)
    ]
