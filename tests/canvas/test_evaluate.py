"""Definitions evaluated without Grasshopper: matching of data, scripts, toggles, what is said and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from hookean.errors import InputError
from hookean_canvas.archive import Type
from hookean_canvas.command import app
from hookean_canvas.definitions.write import Definition, flat, graft
from hookean_canvas.run import graph
from hookean_canvas.run.checking import check, number, shown
from hookean_canvas.run.evaluate import Canvas, Outcome
from hookean_canvas.run.natives import BY_NAME, Unfit, as_kind
from hookean_canvas.run.scripts import handed, tree_of
from hookean_canvas.run.stand_in import GH_Path
from hookean_canvas.run.trees import FLATTEN, GRAFT, ITEM, LIST, TREE, Tree, modified, path_of, runs, text_of
from serving import HANG

paths = st.lists(st.integers(0, 5), min_size=1, max_size=3).map(tuple)
trees = st.dictionaries(paths, st.lists(st.integers(), max_size=5), max_size=6).map(Tree)


def ran(d: Definition, **settings: str) -> Outcome:
    """What a definition comes to."""
    return Canvas(graph.of(d.archive()), settings).run(HANG)


def values(outcome: Outcome, panel: str) -> dict[str, list[Any]]:
    return {text_of(path): items for path, items in outcome.panels[panel].branches()}


# trees


def test_items_are_matched_by_the_longest_list_and_the_last_repeats() -> None:
    found = list(runs([(ITEM, Tree.of([1, 2, 3])), (ITEM, Tree.of([10, 20]))]))
    assert [run.values for run in found] == [[1, 10], [2, 20], [3, 20]]
    assert {run.path for run in found} == {(0,)}


def test_branches_are_matched_by_their_order_and_results_go_to_the_larger_tree() -> None:
    many = Tree({(0, 0): [1, 2], (0, 1): [3], (1,): [4]})
    found = list(runs([(ITEM, Tree.of([10], (7,))), (ITEM, many)]))
    assert [(run.path, run.values) for run in found] == [
        ((0, 0), [10, 1]), ((0, 0), [10, 2]), ((0, 1), [10, 3]), ((1,), [10, 4]),
    ]  # fmt: skip


def test_a_tree_of_many_branches_is_handed_to_scripts_and_back_in_steps_that_grow_with_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each branch is looked up a few times, however many others there are: a grafted mesh has thousands."""
    looked = 0
    plain = GH_Path.__str__

    def counted(path: Any) -> str:
        nonlocal looked
        looked += 1
        return str(plain(path))

    monkeypatch.setattr(GH_Path, "__str__", counted)
    branches = 400
    tree = Tree({(0, i): [i, -i] for i in reversed(range(branches))})
    assert tree_of(handed(tree)) == tree
    assert looked <= 10 * branches


def test_a_list_input_gets_a_branch_at_once_and_a_tree_input_everything() -> None:
    tree = Tree({(0,): [1, 2], (1,): [3]})
    found = list(runs([(LIST, tree), (TREE, tree), (ITEM, Tree.of([5, 6]))]))
    assert [run.values for run in found] == [
        [[1, 2], tree, 5], [[1, 2], tree, 6], [[3], tree, 5], [[3], tree, 6],
    ]  # fmt: skip


def test_without_data_there_is_one_run() -> None:
    [run] = runs([(ITEM, Tree()), (LIST, Tree()), (TREE, Tree())])
    assert (run.path, run.values) == ((0,), [None, [], Tree()])


@given(trees)
def test_flattening_and_grafting_keep_every_item_in_order(tree: Tree) -> None:
    assert modified(tree, FLATTEN).values_in_order() == tree.values_in_order()
    grafted = modified(tree, GRAFT)
    assert [grafted[(*path, i)] for path in tree for i in range(len(tree[path]))] == [
        [v] for b in tree.values() for v in b
    ]
    assert all(len(items) == 1 for items in grafted.values())
    assert modified(modified(tree, reverse=True), reverse=True) == tree


@given(trees)
def test_simplified_paths_are_shorter_and_stay_different(tree: Tree) -> None:
    simple = modified(tree, simplify=True)
    assert len(simple) == len(tree) and simple.values_in_order() == tree.values_in_order()
    assert sum(map(len, simple)) <= sum(map(len, tree))


@given(paths)
def test_paths_are_written_and_read_as_grasshopper_does(path: tuple[int, ...]) -> None:
    assert path_of(text_of(path)) == path


# natives and conversions


@pytest.mark.parametrize(
    ("name", "given", "found"),
    [
        ("Construct Point", (1.0, 2.0, 3.0), ["{1, 2, 3}"]),
        ("Vector XYZ", (3.0, 0.0, 4.0), ["{3, 0, 4}", "5"]),
        ("Unit Z", (-10.0,), ["{0, 0, -10}"]),
        ("Series", (1.0, 0.5, 4), ["1, 1.5, 2, 2.5"]),
        ("List Length", (["a", "b"],), ["2"]),
    ],
)
def test_native_components_do_what_their_tooltips_say(name: str, given: tuple[Any, ...], found: list[str]) -> None:
    results = [r if isinstance(r, list) else [r] for r in BY_NAME[name].run(*given)]
    assert [shown(Tree.of(result)) for result in results] == found


def test_a_list_from_item_inputs_gets_a_path_of_its_own_for_each_run() -> None:
    d = Definition("series", "Series", "Lists.")
    counts = d.parameter("Integer", "Counts", [2, 3])
    d.panel("found", d.native("Series", start=0, step=1, count=counts))
    assert values(ran(d), "found") == {"{0;0}": [0.0, 1.0], "{0;1}": [0.0, 1.0, 2.0]}


@pytest.mark.parametrize(
    ("kind", "value", "found"),
    [
        ("number", "1e-12", 1e-12),
        ("integer", 2.5, 3),
        ("integer", -0.4, 0),
        ("boolean", "true", True),
        ("text", 2, "2"),
    ],
)
def test_values_are_converted_as_grasshopper_converts_them(kind: str, value: Any, found: Any) -> None:
    assert as_kind(kind, value) == found


def test_points_are_read_from_text_and_what_does_not_fit_is_said() -> None:
    assert shown(Tree.of([as_kind("point", "{1.5, -2, 3e1}")])) == "{1.5, -2, 30}"
    with pytest.raises(Unfit, match="from Text to Number"):
        as_kind("number", "ten")


# definitions


def test_modifiers_of_inputs_and_branches_reach_a_script_as_in_grasshopper() -> None:
    d = Definition("modifiers", "Modifiers", "Flat, grafted, as it is.")
    numbers = d.parameter("Number", "Numbers", [1.0, 2.0, 3.0])
    code = "n = len(x)"
    d.panel("as it is", d.script("A", code, {"x": numbers}, ["n"], lists=["x"]))
    d.panel("grafted", d.script("B", code, {"x": graft(numbers)}, ["n"], lists=["x"]))
    d.panel("flat", d.script("C", code, {"x": flat(numbers, numbers)}, ["n"], lists=["x"]))
    d.panel("items", d.script("D", "n = 10 * x", {"x": numbers}, ["n"]))
    d.panel("tree", d.script("E", "n = [str(path) for path in x.Paths]", {"x": graft(numbers)}, ["n"], trees=["x"]))
    found = ran(d)
    assert values(found, "as it is") == {"{0}": [3]}
    assert values(found, "grafted") == {"{0;0}": [1], "{0;1}": [1], "{0;2}": [1]}
    assert values(found, "flat") == {"{0}": [6]}
    assert values(found, "items") == {"{0}": [10.0, 20.0, 30.0]}
    assert values(found, "tree") == {"{0}": ["{0;0}", "{0;1}", "{0;2}"]}


def test_sliders_toggles_lists_and_panels_give_their_values_and_can_be_set() -> None:
    d = Definition("values", "Values", "What a person sets.")
    given = {
        "whole": d.slider("Whole", 3, 0, 10), "part": d.slider("Part", 0.25, 0, 1, decimals=2),
        "on": d.toggle("On", True), "pattern": d.choice("Pattern", {"Both": '"both"', "None": "0"}, "Both"),
        "small": d.text("Small", "1e-9"),
    }  # fmt: skip
    code = "found = '%r %r %r %r %r' % (whole, part, on, pattern, small)"
    d.panel("found", d.script("Show", code, given, ["found"]))
    assert values(ran(d), "found") == {"{0}": ["3 0.25 True 'both' '1e-9'"]}
    other = ran(d, Whole="7", Part="0.126", On="false", Pattern="None", Small="2")
    assert values(other, "found") == {"{0}": ["7 0.13 False 0 '2'"]}
    for name, value, said in [
        ("Whole", "11", "ranges from 0 to 10"), ("On", "perhaps", "give True or False"),
        ("Pattern", "Some", "not one of its choices Both, None"), ("Wide", "1", "Part, Pattern"),
    ]:  # fmt: skip
        with pytest.raises(InputError, match=said):
            ran(d, **{name: value})


COUNTING = """
import sys

state = sys.__dict__.setdefault("_hookean_test_counts", {})
key = str(ghenv.Component.InstanceGuid)
if _reset:
    state[key] = 0
else:
    state[key] += 1
    if state[key] < 5:
        component = ghenv.Component
        component.OnPingDocument().ScheduleSolution(1, lambda document: component.ExpireSolution(False))
count = state[key]
"""


def counting(key: str) -> Definition:
    """A script that wants to be solved until it has counted to five."""
    d = Definition(key, "Counting", "Scheduled solutions.")
    d.panel("count", d.script("Count", COUNTING, {"_reset": d.toggle("Reset", True)}, ["count"]))
    return d


def test_reset_is_pressed_and_let_go_and_scheduled_solutions_run_to_the_end() -> None:
    found = ran(counting("counting"))
    assert values(found, "count") == {"{0}": [5]} and found.at_rest
    assert found.solutions == 6  # one with True, five with False
    held = ran(counting("held"), Reset="True")
    assert values(held, "count") == {"{0}": [0]} and held.solutions == 1


def test_what_never_rests_is_told() -> None:
    d = Definition("restless", "Restless", "It never rests.")
    d.panel("x", d.script("Again", COUNTING.replace("< 5", "< 10**9"), {"_reset": d.toggle("Reset", True)}, ["count"]))
    found = Canvas(graph.of(d.archive())).run(solutions=9)
    assert not found.at_rest and found.solutions == 9


def test_what_a_script_raises_is_an_error_on_it_and_the_rest_goes_on() -> None:
    d = Definition("raising", "Raising", "One of two fails.")
    x = d.slider("X", 0, 0, 5)
    d.panel("bad", d.script("Bad", "y = 1\ny = 1 / x", {"x": x}, ["y"]))
    d.panel("good", d.script("Good", "print('hidden')\ny = x + 1", {"x": x}, ["y"]))
    found = ran(d)
    assert [(m.component, m.level, m.text) for m in found.messages] == [
        ("Bad", "error", "ZeroDivisionError: division by zero [line 3]")
    ]
    assert values(found, "good") == {"{0}": [1]} and values(found, "bad") == {}


def test_all_unknown_objects_are_named_at_once() -> None:
    d = Definition("unknown", "Unknown", "Components without a stand-in.")
    point = d.point(0, 0, 0)
    d.native("Line", start_point=point, end_point=point)
    root = d.archive()
    for chunk in root.walk():
        if chunk.value("Name") == "Line" and chunk.item("GUID"):
            chunk.put("GUID", Type.GUID, graph.UUID("9b2ed0e5-3e2b-4a0b-8b1b-000000000001")).put(
                "Lib", Type.GUID, graph.UUID(int=1)
            )
        if chunk.value("Name") == "Construct Point" and chunk.item("GUID"):
            chunk.put("GUID", Type.GUID, graph.UUID("9b2ed0e5-3e2b-4a0b-8b1b-000000000002")).put(
                "Lib", Type.GUID, graph.UUID(int=2)
            )
    with pytest.raises(InputError, match=r"nothing was run.* 1 x Construct Point: .*; 1 x Line: ") as caught:
        Canvas(graph.of(root))
    assert len(caught.value.faults) == 2


def test_a_disabled_component_gives_nothing() -> None:
    d = Definition("locked", "Locked", "One is disabled.")
    d.panel("x", d.native("List Length", list=d.parameter("Number", "Numbers", [1.0])))
    found = graph.of(d.archive())
    next(node for node in found.nodes if node.label == "Lng").locked = True
    assert Canvas(found).run().panels["x"] == {}


# against what is expected


def expecting(folder: Path, value: float) -> Path:
    """A definition that shows 12, beside an expected.json."""
    d = Definition("expecting", "Expecting", "Twelve.")
    d.numbers("a = 2 * x", {"x": d.slider("X", 6, 0, 10)}, {"a": "twice"})
    folder.mkdir()
    d.save(folder / "definition.ghx")
    entry = {"unit": "m", "value": value, "tolerance": 0.5, "source": "closed form: 2 x 6"}
    text = {"title": "Twelve", "figures": ["0.1"], "numbers": {"twice": entry}}
    (folder / "expected.json").write_text(json.dumps(text), encoding="utf-8")
    return folder / "definition.ghx"


def test_panels_are_compared_with_the_numbers_beside_the_file(tmp_path: Path) -> None:
    assert check(expecting(tmp_path / "good", 12.0)).faults == []
    assert check(expecting(tmp_path / "bad", 13.0)).faults == ["twice: 12 m, expected 13 ± 0.5"]
    missing = expecting(tmp_path / "missing", 12.0)
    text = (missing.parent / "expected.json").read_text(encoding="utf-8")
    (missing.parent / "expected.json").write_text(text.replace('"twice"', '"thrice"'), encoding="utf-8")
    assert check(missing).faults == ["thrice: nothing, expected 12 ± 0.5"]


def test_the_command_prints_panels_and_says_by_its_code_whether_all_is_well(tmp_path: Path) -> None:
    good, bad = expecting(tmp_path / "good", 12.0), expecting(tmp_path / "bad", 13.0)
    shell = CliRunner()
    found = shell.invoke(app, ["run", str(good)])
    assert (found.exit_code, found.stdout) == (0, "twice: 12\n1 of 1 numbers of expected.json are as expected\n")
    assert shell.invoke(app, ["run", str(bad)]).exit_code == 1
    found = shell.invoke(app, ["run", str(bad), "--set", "X=4", "--json"])
    assert found.exit_code == 0 and json.loads(found.stdout)["panels"] == {"twice": {"{0}": [8]}}
    found = shell.invoke(app, ["run", str(bad), "--set", "Y=4"])
    assert found.exit_code == 2 and found.stderr.startswith("hookean: Y: no input that can be set has this name")


def test_a_drawing_shows_where_things_stand(tmp_path: Path) -> None:
    path = expecting(tmp_path / "drawn", 12.0)
    assert CliRunner().invoke(app, ["draw", str(path), "-o", str(tmp_path / "x.png")]).exit_code == 0
    data = (tmp_path / "x.png").read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and int.from_bytes(data[16:20]) > 500


def test_only_one_number_counts_as_one() -> None:
    assert number(Tree.of(["1e-3"])) == 1e-3 and number(Tree.of([True])) == 1.0
    assert number(Tree.of([1.0, 2.0])) is None and number(Tree.of(["no"])) is None and number(Tree()) is None
    assert number(Tree.of([float("nan")])) is None
