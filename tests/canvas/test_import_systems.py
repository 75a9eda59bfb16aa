"""An import swaps whole systems only: a solver with all its goals or none of them, a goal only with its solver.

Half a system runs nowhere: Kangaroo's solver takes Kangaroo's goals only, the Engine takes hookean's only. Goals are
followed through merges, lists, relays and clusters; what else stands where goals come from is named.
"""

from __future__ import annotations

from typing import Any
from uuid import UUID, uuid5

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canvas.kangaroo_samples import ANCHOR, LENGTH, SOLVER, Kangaroo, in_units, store
from canvas.test_import import remaining, same_objects, the, translated
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import PARAMETERS, PYTHON3_SCRIPT
from hookean_canvas.archive.parts import parts
from hookean_canvas.definitions.write import Made
from hookean_canvas.inspect import drawing, lint
from hookean_canvas.inspect.describe import describe
from hookean_canvas.inspect.show import lines, text
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.report import Report
from hookean_canvas.run import graph
from serving import SOAK

MERGE = "3cadddef-1e2b-4c09-9390-0e8f78f7609f"
LIST_ITEM = "59daf374-bc21-4a5e-8282-5504fb7ae9ae"
STREAM_FILTER = "eeafc956-268e-461d-8e73-ee05c6f72c01"
SOFT = UUID("3c30b1a1-4473-4ad4-a700-ea9770726c03")
"""The Anchor with a target."""
CSHARP = "a9a8ebd2-fff5-4c44-a8f5-739736d129ba"


def start(name: str = "systems") -> tuple[Kangaroo, Made]:
    """A definition with a line."""
    d = Kangaroo(name, "Systems", "Solvers and their goals.")
    return d, d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0))


def sprung() -> tuple[Kangaroo, Made, Made]:
    """A definition with a line, and a spring on it."""
    d, line = start()
    return d, line, d.kangaroo("Length(Line)", LENGTH, ["S"], line=line)


def whole(d: Kangaroo) -> Report:
    """The report of an import that translates all systems; every component of Kangaroo is gone but tools that stay."""
    _, report = translated(d)
    assert report.solvers == report.whole > 0
    assert all("stays on" in why for _, why in report.stays), report.stays
    assert len(report.swapped) == report.kangaroo - len(report.stays)
    return report


def untouched(d: Kangaroo) -> dict[str, str]:
    """Why each component stays, after an import that changes no object at all."""
    after, report = translated(d)
    assert (report.whole, report.swapped, report.lost) == (0, [], []) and report.kept == report.wires
    assert same_objects(d.archive(), after) == []
    assert not any(part.container.value("Locked") for part in parts(after) if part.container)
    return dict(report.stays)


def test_a_goal_of_another_plug_in_keeps_the_system_and_is_named_with_nickname_and_plug_in() -> None:
    d, line, spring = sprung()
    bar = d.foreign("Bar", ["Line"], line=line)
    bar.container.put("NickName", Type.STRING, "B1")
    d.solved(spring, bar)
    assert untouched(d) == {
        'Bar "B1" (plug-in Engineering 1.2)': "it makes goals for Solver and is not Kangaroo's",
        "Length(Line)": "it stays with Solver",
        "Solver": 'it stays with all its goals, because of Bar "B1" (plug-in Engineering 1.2)',
    }


def test_a_goal_of_a_script_keeps_the_system_and_is_named() -> None:
    d, _, spring = sprung()
    made = d.script("Wind", "goal = 1", {}, ["goal"])
    old = d.native_like("C# Script", CSHARP, ["x"], "A")
    d.solved(spring, made, old)
    assert set(untouched(d)) == {'Python 3 Script "Wind" (a script)', "C# Script (a script)", "Length(Line)", "Solver"}


def test_plug_ins_and_scripts_that_make_geometry_or_numbers_for_goals_stand_in_no_way() -> None:
    d, line = start()
    mesh = d.foreign("Remesher", ["In"], **{"in": line})
    strength = d.script("Strength", "k = 3.0", {}, ["k"])
    d.solved(d.kangaroo("Length(Line)", LENGTH, ["S"], line=mesh, strength=strength))
    whole(d)


def test_goals_are_followed_through_merges_lists_relays_and_clusters() -> None:
    """The index of the list comes from a script, the gate from a plug-in: neither is a goal."""
    d, _, spring = sprung()
    soft = d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=d.point(0, 0, 0))
    merged = d.native_like("Merge", MERGE, ["Data 1", "Data 2"], "Result", data_1=spring, data_2=soft)
    item = d.native_like(
        "List Item", LIST_ITEM, ["List", "Index"], "Item", list=merged, index=d.script("Which", "i = 0", {}, ["i"])
    )
    gate = d.foreign("Gate")
    kept = d.native_like("Stream Filter", STREAM_FILTER, ["Gate", "Stream 0"], "Stream", gate=gate, stream_0=item)
    inner = Kangaroo("inner", "Inner", "Nothing of Kangaroo.")
    inner.parameter("Data", "In")
    cluster = d.cluster("Tidy", archive.to_bytes(inner.archive()), kept)
    d.solved(d.parameter("Data", "All", source=cluster))
    report = whole(d)
    assert [what for what, _, _ in report.swapped] == ["Length(Line)", "Anchor", "Solver"]


def hidden_goals() -> bytes:
    inner = Kangaroo("inner", "Inner", "A goal.")
    inner.kangaroo("Smooth", (("M", None),), ["P"])
    return archive.to_bytes(inner.archive())


def nested() -> bytes:
    outer = Kangaroo("outer", "Outer", "A cluster in a cluster.")
    outer.cluster("Inner", hidden_goals())
    return archive.to_bytes(outer.archive())


@pytest.mark.parametrize(
    ("document", "told"),
    [
        (hidden_goals(), "a cluster that holds Smooth of Kangaroo"),
        (nested(), "a cluster that holds a cluster that holds Smooth of Kangaroo"),
        (b"locked", "a cluster that cannot be opened"),
    ],
    ids=["goals", "nested", "locked"],
)
def test_a_cluster_that_may_make_goals_keeps_the_system(document: bytes, told: str) -> None:
    d, _, spring = sprung()
    d.solved(spring, d.cluster("Goals", document))
    found = untouched(d)
    assert f"Goals ({told})" in found or f'Cluster "Goals" ({told})' in found


def test_a_goal_that_nothing_takes_is_translated_alone() -> None:
    """Nothing can miss it: it ends in panels and merges."""
    d, _, _ = sprung()
    d.panel("shown", d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, 1.0))), ["U"], p=d.point(0, 0, 0)))
    after, report = translated(d)
    assert report.stays == [] and remaining(after) == 0 and len(report.swapped) == 2


def test_a_goal_whose_only_taker_is_a_script_stays_and_the_script_is_named() -> None:
    d, _, spring = sprung()
    d.script("My solver", "out = goals", {"goals": spring}, ["out"])
    assert untouched(d)["Length(Line)"] == (
        'it flows into no solver of Kangaroo, only into Python 3 Script "My solver" (a script); a goal is translated '
        "with its solver"
    )


def test_a_goal_that_a_script_takes_too_keeps_the_system() -> None:
    d, _, spring = sprung()
    merged = d.native_like("Merge", MERGE, ["Data 1"], "Result", data_1=spring)
    d.solved(merged)
    d.script("Other", "out = goals", {"goals": merged}, ["out"])
    assert untouched(d)['Python 3 Script "Other" (a script)'] == "it takes goals of Solver and is not Kangaroo's"


def test_shapes_that_a_goal_gives_beside_itself_are_anybodys() -> None:
    """A goal comes out of the first output; what comes out of others, such as frames, is geometry."""
    d, line = start()
    goal = d.kangaroo("Length(Line)", LENGTH, ["S", "Lines"], line=line)
    d.solved(goal["S"])
    d.script("Draw", "out = lines", {"lines": goal["Lines"]}, ["out"])
    _, report = translated(d)
    assert (report.solvers, report.whole) == (1, 1)


def test_two_solvers_are_decided_each_on_its_own() -> None:
    d, line, spring = sprung()
    d.solved(spring)
    bar = d.foreign("Bar", ["Line"], line=line)
    other = d.kangaroo("Length(Line)", LENGTH, ["S"], line=line)
    made = d.solved(other, bar)
    made.container.put("NickName", Type.STRING, "Second")
    after, report = translated(d)
    assert (report.solvers, report.whole) == (2, 1)
    kinds = {part.id: part.guid for part in parts(after)}
    assert kinds[spring.id] == PYTHON3_SCRIPT and kinds[other.id] == other.guid and kinds[made.id] == made.guid
    assert dict(report.stays)["Length(Line)"] == "it stays with Second"
    assert "1 of 2 solvers translated with all goals" in report.text()


@pytest.mark.parametrize("foreign", [False, True])
def test_solvers_that_share_a_goal_are_translated_both_or_neither(foreign: bool) -> None:
    d, line, spring = sprung()
    other = [d.foreign("Bar", ["Line"], line=line)] if foreign else []
    soft = d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=d.point(0, 0, 0))
    d.solved(spring, soft)
    d.solved(soft, *other).container.put("NickName", Type.STRING, "Second")
    if foreign:
        found = untouched(d)
        assert found["Length(Line)"] == found["Anchor"] == "it stays with Solver and Second"
    else:
        assert whole(d).solvers == 2


def test_a_solver_fed_by_the_shapes_of_another_is_a_system_of_its_own() -> None:
    """The first has a goal without counterpart; the second takes its points for springs of its own."""
    d, line = start()
    first = d.solved(d.kangaroo("G2", (("P1", None),), ["G"], p1=line))
    ends = d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=first["V"])
    last = d.kangaroo(
        "Solver", SOLVER, ["I", "V", "O"], goalobjects=[ends, d.parameter("Data", "Shapes", source=first["O"])]
    )
    after, report = translated(d)
    assert (report.solvers, report.whole) == (2, 1)
    kinds = {part.id: part.guid for part in parts(after)}
    assert kinds[last.id] == kinds[ends.id] == PYTHON3_SCRIPT and kinds[first.id] == first.guid


@pytest.mark.parametrize("name", ["Stripper", "TangentCircles", "Unroller"])
def test_tools_that_make_geometry_stay_on_and_stand_in_no_way(name: str) -> None:
    """The ids are those of public definitions; each tool stands between a line and a goal, and after the solver."""
    d, line = start()
    before = d.kangaroo(name, (("Curves", None),), ["Out"], curves=line)
    solver = d.solved(d.kangaroo("Length(Line)", LENGTH, ["S"], line=before))
    d.kangaroo(name, (("Curves", None),), ["Out"], curves=solver["O"])
    report = whole(d)
    assert report.stays == 2 * [(name, "a tool for geometry; it stays on, as it comes with Rhino")]
    after, _ = translated(d)
    assert [part.chunk for part in parts(after) if part.name == name and not part.container.value("Locked")] == [  # type: ignore[union-attr]
        part.chunk for part in parts(d.archive()) if part.name == name
    ]


def test_a_tool_with_a_counterpart_stays_with_the_system_that_it_feeds() -> None:
    for foreign in (False, True):
        d, line = start()
        vertices = d.kangaroo("NakedVertices", (("Mesh", None),), ["NakedPts"], mesh=d.parameter("Mesh", "Mesh"))
        soft = d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=vertices)
        d.solved(soft, *([d.foreign("Bar", ["Line"], line=line)] if foreign else []))
        if foreign:
            assert untouched(d)["NakedVertices"] == "a tool for geometry; it stays with the system that it feeds"
        else:
            assert whole(d).stays == []


@pytest.mark.parametrize("typed", [True, False])
def test_an_anchor_by_index_keeps_its_system(typed: bool) -> None:
    """Without its index such an anchor would hold nothing."""
    d, _, spring = sprung()
    given = (("Point", None), ("Index", None), ("Strength", 1000.0))
    guid = UUID("b476d3d0-4daf-489c-b91a-49f5dd72a256")
    wires: dict[str, Any] = {} if typed else {"index": d.slider("i", 0, 0, 9)}
    anchor = d.kangaroo("Anchor", given, ["A"], guid=guid, **wires)
    if typed:
        store(anchor.inputs["index"][1], [3])
    d.solved(spring, anchor)
    assert untouched(d)["Anchor"] == "it goes by index, and no solver has Points"


def test_grab_becomes_ours_with_its_range_and_strength() -> None:
    d, _, spring = sprung()
    given = (("On", True), ("Strength", 1.0), ("Range", 3.0))
    grab = d.kangaroo("Grab", given, ["Grab"], on=d.toggle("Drag", True))
    d.solved(spring, grab)
    after, report = translated(d)
    assert report.whole == 1 and report.lost == [] and report.values == [] and remaining(after) == 0
    assert the(after, "Grab").guid not in PARAMETERS.values()


KINDS = [("Length(Line)", "Line"), ("Load", "P"), ("EdgeLengths", "Mesh"), ("G2", "P1"), ("Show", "G")]
TRANSLATED = {"Length(Line)", "Load", "EdgeLengths", "Show"}


@pytest.mark.soak
@settings(max_examples=400 if SOAK else 20, deadline=None)
@given(st.data())
def test_of_any_solvers_and_goals_each_system_is_translated_whole_or_not_at_all(data: st.DataObject) -> None:
    """Goals, merges of them and solvers at random; which goals reach which solver is counted here by hand."""
    d, line = start("random")
    reaches: dict[UUID, set[UUID]] = {}
    made: dict[UUID, Made] = {}
    for _ in range(data.draw(st.integers(1, 6))):
        name, port = data.draw(st.sampled_from(KINDS))
        goal = d.kangaroo(name, ((port, None),), ["G"], **{port.lower(): line})
        made[goal.id], reaches[goal.id] = goal, {goal.id}
    for _ in range(data.draw(st.integers(0, 3))):
        fed = data.draw(st.lists(st.sampled_from(list(made.values())), min_size=1, max_size=3, unique_by=id))
        merged = d.parameter("Data", "Goals")
        d._wire(merged, "in", fed)
        made[merged.id], reaches[merged.id] = merged, set().union(*(reaches[one.id] for one in fed))
    solvers: list[tuple[Made, set[UUID]]] = []
    for _ in range(data.draw(st.integers(0, 3))):
        fed = data.draw(st.lists(st.sampled_from(list(made.values())), max_size=4, unique_by=id))
        solvers.append((d.solved(*fed), set().union(*(reaches[one.id] for one in fed))))
    whole_: dict[UUID, bool] = dict.fromkeys((solver.id for solver, _ in solvers), True)
    for _ in solvers:  # as often as the verdict on one can be handed on to others that share a goal
        for solver, goals in solvers:
            others = [other for other, theirs in solvers if goals & theirs]
            good = all(made[goal].kind in TRANSLATED for goal in goals)
            whole_[solver.id] &= good and all(whole_[other.id] for other in others)
    after, report = translated(d)
    swapped = {part.id for part in parts(after) if part.guid == PYTHON3_SCRIPT}
    shown = {one.outputs["G"][0]: one.id for one in made.values() if one.kind == "Show"}
    swapped |= {shown[part.id] for part in parts(after) if part.id in shown}  # a parameter has the id of its output
    expected = {solver.id for solver, _ in solvers if whole_[solver.id]}
    expected |= {goal for solver, goals in solvers if whole_[solver.id] for goal in goals}
    held = {goal for _, goals in solvers for goal in goals}
    expected |= {one.id for one in made.values() if one.kind in TRANSLATED and one.id not in held}
    assert swapped & {*made, *whole_} == expected
    assert (report.solvers, report.whole) == (len(solvers), sum(whole_.values()))


# --------------------------------------------------------------------------------------------------- evaluation units


def units(goal: bool) -> tuple[Kangaroo, Made]:
    """A plug-in's component that keeps its outputs in evaluation units: it makes geometry for a goal, or a goal."""
    d, line = start("units")
    made = in_units(d.foreign("Switcher", ["In"], **{"in": line}), "Idle")
    d.solved(made if goal else d.kangaroo("Length(Line)", LENGTH, ["S"], line=made))
    return d, made


def test_wires_out_of_evaluation_units_are_kept_and_seen(tmp_path: Any) -> None:
    d, made = units(goal=False)
    report = whole(d)
    assert report.wires == report.kept
    after, _ = kangaroo.translate(d.archive())
    output = made.outputs["R"][0]
    for root in (d.archive(), after):
        found = graph.of(root)
        [(start_, port, _, _)] = [wire for wire in found.wires() if wire[1].id == output]
        assert (start_.id, port.nickname) == (made.id, "R")
        assert lint.faults(root) == []
        assert "<- Switcher.R" in text(lines(describe(root), "a.gh"))
        drawing.draw(found, tmp_path / "a.png")
    assert "Idle" not in text(lines(describe(d.archive()), "a.gh"))  # of a unit that is not in use


def test_a_goal_out_of_an_evaluation_unit_is_named() -> None:
    d, _ = units(goal=True)
    assert untouched(d)["Switcher (plug-in Engineering 1.2)"] == "it makes goals for Solver and is not Kangaroo's"


def test_units_count_all_where_none_is_said_to_be_in_use() -> None:
    d, made = units(goal=False)
    for name in (None, "elsewhere"):
        root = d.archive()
        [switcher] = [part.container for part in parts(root) if part.id == made.id]
        assert isinstance(switcher, Chunk)
        switcher.chunks = [chunk for chunk in switcher.chunks if chunk.name != "ActiveUnit"]
        if name:
            switcher.add("ActiveUnit").put("unitname", Type.STRING, name)
        node = next(node for node in graph.of(root).nodes if node.id == made.id)
        assert [port.nickname for port in node.outputs] == ["Idle", "R"]
        assert node.outputs[0].id == uuid5(made.id, "idle 0")
