"""Natives do what their tooltips in Grasshopper describe, each on small values with a known answer."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near, plain
from canvas.natives_table import LISTS, MATHS, VECTORS, XY
from hookean_canvas.archive import Chunk, Type, guids
from hookean_canvas.definitions.write import Definition, flat
from hookean_canvas.kangaroo.ids import COMPONENTS
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas, Outcome
from hookean_canvas.run.natives import BY_NAME, INERT, NATIVES, PARAMETERS, Unfit
from hookean_canvas.run.natives.expressions import evaluated
from hookean_canvas.run.trees import Tree, text_of


@pytest.mark.parametrize(("name", "given", "expected"), [*LISTS, *MATHS, *VECTORS], ids=lambda part: str(part)[:40])
def test_a_native_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    assert near(run(name, *given), list(expected)), run(name, *given)


class Stored:
    """An object as a native sees it: the names of its inputs and outputs, and what is stored in it."""

    def __init__(self, names: list[str], **items: Any) -> None:
        self.inputs = self.outputs = [graph.Port(UUID(int=i), name, name) for i, name in enumerate(names)]
        self.container = Chunk("Container")
        for name, value in items.items():
            kinds = {bool: Type.BOOL, int: Type.INT32}
            self.container.put(name, kinds.get(type(value), Type.STRING), value)


def test_list_item_has_outputs_for_items_before_and_after_and_wraps() -> None:
    node = Stored(["i", "+1", "-1"])
    assert run("List Item", list("abc"), 2, True, node=node) == ["c", "a", "b"]
    assert run("List Item", list("abc"), 2, False, node=node) == ["c", None, "b"]


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (0, "aa ab ac ba bb bc ca cb cc"),
        (1, "ab ac ba bc ca cb"),
        (2, "ab ac ba bc ca cb"),
        (3, "aa ba bb ca cb cc"),
        (4, "aa ab ac bb bc cc"),
        (5, "ba ca cb"),
        (6, "ab ac bc"),
    ],
)
def test_cross_reference_leaves_out_the_combinations_that_its_menu_says(mode: int, expected: str) -> None:
    """A public definition stores 5 for contacts between all bodies: each pair once, and none with itself."""
    first, second = run("Cross Reference", list("abc"), list("abc"), node=Stored([], CrossMode=mode))
    assert [a + b for a, b in zip(first, second, strict=True)] == expected.split()


def test_cross_reference_takes_more_lists() -> None:
    found = run("Cross Reference", [0, 1], [0, 1], [0, 1], node=Stored([], CrossMode=2))
    assert list(map(tuple, found)) == [(), (), ()]  # two of three are always the same of two
    found = run("Cross Reference", [0, 1], [2], [3, 4], node=Stored([]))
    assert [list(one) for one in found] == [[0, 0, 1, 1], [2, 2, 2, 2], [3, 4, 3, 4]]
    with pytest.raises(Unfit, match="unknown mode 9"):
        run("Cross Reference", [0], [0], node=Stored([], CrossMode=9))


# trees

TREE = Tree({(0, 0): [1, 2], (0, 1): [3]})


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("Merge", [TREE, Tree({(0, 1): [4], (5,): [6]})], {(0, 0): [1, 2], (0, 1): [3, 4], (5,): [6]}),
        ("Graft Tree", [TREE], {(0, 0, 0): [1], (0, 0, 1): [2], (0, 1, 0): [3]}),
        ("Flatten Tree", [TREE, Tree()], {(0,): [1, 2, 3]}),
        ("Flatten Tree", [TREE, Tree.of([(7,)])], {(7,): [1, 2, 3]}),
        ("Simplify Tree", [TREE, Tree()], {(0,): [1, 2], (1,): [3]}),
        ("Simplify Tree", [Tree({(0, 1, 0): [1], (0, 2, 0): [2]}), Tree()], {(1,): [1], (2,): [2]}),
        ("Simplify Tree", [Tree({(0, 1, 0): [1], (0, 2, 0): [2]}), Tree.of([True])], {(1, 0): [1], (2, 0): [2]}),
        ("Simplify Tree", [Tree({(0, 0): [1]}), Tree()], {(0, 0): [1]}),
        ("Simplify Tree", [Tree({(0,): [1], (0, 2): [2]}), Tree()], {(0,): [1], (0, 2): [2]}),
        ("Clean Tree", [*[Tree.of([True])] * 3, Tree({(0,): [1, None], (1,): [None]})], {(0,): [1]}),
        ("Clean Tree", [Tree.of([True]), Tree(), Tree(), Tree({(0,): [1, None], (1,): [None]})],
         {(0,): [1], (1,): []}),
        ("Flip Matrix", [Tree({(0,): [1, 2], (1,): [3, 4], (2,): [5]})], {(0,): [1, 3, 5], (1,): [2, 4, None]}),
        ("Tree Branch", [TREE, Tree.of([(0, 1)])], {(0, 1): [3]}),
        ("Tree Item", [TREE, Tree.of([(0, 0)]), Tree.of([-1]), Tree.of([True])], {(0,): [2]}),
        ("Unflatten Tree", [Tree.of("abc"), TREE], {(0, 0): ["a", "b"], (0, 1): ["c"]}),
        ("Trim Tree", [TREE, Tree.of([1])], {(0,): [1, 2, 3]}),
        ("Shift Paths", [TREE, Tree.of([-1])], {(0,): [1, 2, 3]}),
        ("Shift Paths", [TREE, Tree.of([1])], {(0,): [1, 2], (1,): [3]}),
        ("Prune Tree", [TREE, Tree.of([2]), Tree.of([0])], {(0, 0): [1, 2]}),
        ("Stream Filter", [Tree.of([1]), Tree.of("a"), Tree.of("b")], {(0,): ["b"]}),
    ],
)  # fmt: skip
def test_a_native_of_trees_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    assert run(name, *given) == [expected]


def test_entwine_explode_tree_and_stream_gate_follow_their_outputs() -> None:
    three = Stored(["0", "1", "2"])
    assert run("Entwine", TREE, Tree.of("a"), node=three) == [{(0, 0): [1, 2, 3], (0, 1): ["a"]}]
    kept = Stored([], FlattenInputs=False)
    assert run("Entwine", TREE, Tree.of("a"), node=kept) == [{(0, 0, 0): [1, 2], (0, 0, 1): [3], (1, 0): ["a"]}]
    assert run("Explode Tree", TREE, node=three) == [{(0, 0): [1, 2]}, {(0, 1): [3]}, {}]
    assert run("Stream Gate", TREE, Tree.of([1]), node=three) == [{}, dict(TREE), {}]
    assert run("Tree Statistics", TREE) == [{(0,): [(0, 0), (0, 1)]}, {(0,): [2, 1]}, {(0,): [2]}]


# expressions


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x^2 + 2*y", 13.0), ("Sin(pi/2)", 1.0), ("if(x > y, x, y)", 3.0), ("x = 3 And Not (y = 3)", True),
        ("Round(2.567, 2)", 2.57), ("-x^2", -9.0), ("7 \\ 2", 3), ("Max(x, y, 10)", 10), ("x <> y", True),
    ],
)  # fmt: skip
def test_an_expression_has_the_value_that_grasshopper_gives_it(text: str, value: Any) -> None:
    assert evaluated(text, {"x": 3.0, "y": 2.0}) == pytest.approx(value)


@pytest.mark.parametrize(
    "text", ["__import__('os')", "x.__class__", "(lambda: 1)()", "[1 for i in x]", "x[0]", "open('a')", "z", "1 +",
             "9**9**9**9", "(9^9999)^9999", "'a' * 9^9", "(" * 300 + ")" * 300, "1/0", "sqrt(-1)"],
)  # fmt: skip
def test_an_expression_calls_nothing_but_known_functions(text: str) -> None:
    with pytest.raises(Unfit):
        evaluated(text, {"x": 3.0})


# in definitions


def ran(d: Definition) -> Outcome:
    return Canvas(graph.of(d.archive())).run(20.0)


def values(outcome: Outcome, panel: str) -> dict[str, list[Any]]:
    return {text_of(path): items for path, items in outcome.panels[panel].branches()}


def test_nulls_stay_at_their_places_and_empty_branches_stay_empty() -> None:
    d = Definition("nulls", "Nulls", "A list with a null, and a branch without items.")
    tree = d.script(
        "Tree",
        "import Grasshopper as gh\nt = gh.DataTree[object]()\n"
        "for v in (1, None, 3): t.Add(v, gh.Kernel.Data.GH_Path(0))\n"
        "t.EnsurePath(gh.Kernel.Data.GH_Path(1))",
        {}, ["t"],
    )  # fmt: skip
    d.panel("sum", d.native("Addition", a=tree, b=d.parameter("Number", "B", [10.0])))
    assert values(ran(d), "sum") == {"{0}": [11, None, 13], "{1}": []}


def test_lists_of_natives_with_list_inputs_stay_in_their_branches() -> None:
    d = Definition("branches", "Branches", "Shift List keeps paths, Divide Curve adds one for each curve.")
    lines = [d.native("Line", start_point=d.point(0, i, 0), end_point=d.point(2, i, 0)) for i in range(2)]
    parts = d.native("Divide Curve", curve=flat(*lines), count=2, kinks=False)
    d.panel("shifted", d.native("Shift List", list=parts["Points"], shift=1, wrap=True))
    found = values(ran(d), "shifted")
    assert {path: [plain(p)[0] for p in row] for path, row in found.items()} == {
        "{0;0}": [1.0, 2.0, 0.0], "{0;1}": [1.0, 2.0, 0.0],
    }  # fmt: skip


def test_an_expression_on_an_input_applies_to_each_value() -> None:
    d = Definition("expression", "Expression", "x * x on an input.")
    negative = d.native("Negative", value=d.parameter("Number", "Numbers", [2.0, 3.0]))
    negative.inputs["value"][1].put("InternalExpression", Type.STRING, "x * x")
    d.panel("found", negative)
    assert values(ran(d), "found") == {"{0}": [-4.0, -9.0]}


def test_objects_that_only_show_do_nothing() -> None:
    d = Definition("shown", "Shown", "A preview beside numbers.")
    d.panel("sum", d.native("Mass Addition", input=d.parameter("Number", "Numbers", [2.0, 3.0]))["Result"])
    root = d.archive()
    held = next(chunk for chunk in root.walk() if chunk.name == "DefinitionObjects")
    shown = held.add("Object", 99).put("GUID", Type.GUID, next(iter(INERT))).put("Name", Type.STRING, "Custom Preview")
    box = shown.add("Container").put("InstanceGuid", Type.GUID, UUID(int=77)).put("Name", Type.STRING, "Custom Preview")
    box.add("param_input", 0).put("InstanceGuid", Type.GUID, UUID(int=78)).put("Name", Type.STRING, "Geometry")
    assert values(Canvas(graph.of(root)).run(20.0), "sum") == {"{0}": [5.0]}


def test_every_native_and_parameter_has_its_name_in_the_table_of_ids() -> None:
    names = {guid: native.name for guid, native in NATIVES.items()}
    assert names == {guid: guids.name(guid) or COMPONENTS[guid].name for guid in NATIVES}
    assert all(guids.name(guid) for guid in (*INERT, *PARAMETERS))


def test_the_page_lists_all_natives() -> None:
    from hookean_canvas.run.natives.listing import END, START, listing

    page = (Path(__file__).parents[2] / "docs" / "canvas.md").read_text(encoding="utf-8")
    assert page.split(START)[1].split(END)[0].strip() == listing().strip()


# curves and meshes


def test_a_circle_divided_in_four_has_points_at_right_angles_and_its_middle_opposite() -> None:
    circle = BY_NAME["Circle"].run(made(XY), 2.0)[0]
    assert near(run("Divide Curve", circle, 4, False)[0], [(2, 0, 0), (0, 2, 0), (-2, 0, 0), (0, -2, 0)])
    assert near(run("Curve Middle", circle), [(-2, 0, 0)]) and near(run("Length", circle), [4 * math.pi])
    area, centre = run("Area", circle)
    assert area == pytest.approx(4 * math.pi, rel=1e-12) and near(centre, (0, 0, 0))


def test_subdivision_of_a_cube_keeps_its_symmetry_and_comes_to_known_vertices() -> None:
    """Catmull and Clark on a cube of side 2: a corner goes to (F + 2 R + 0 P) / 3 = 5/9, an edge's middle to 3/4."""
    corners = [made(("point", side, side, side)) for side in (-1, 1)]
    box = BY_NAME["Mesh Box"].run(BY_NAME["Box 2Pt"].run(*corners, None)[0], 1, 1, 1)[0]
    vertices, faces = run("Weaverbird's Catmull-Clark Subdivision", box, 1, 0)[0]
    assert len(vertices) == 26 and len(faces) == 24
    reach = sorted(np.abs(vertices).tolist())
    assert sum(near(sorted(row), [5 / 9] * 3) for row in reach) == 8
    assert sum(near(sorted(row), [0.0, 0.75, 0.75]) for row in reach) == 12
    assert sum(near(sorted(row), [0.0, 0.0, 1.0]) for row in reach) == 6
