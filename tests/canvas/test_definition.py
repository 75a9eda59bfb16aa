"""Definitions written from Python: wires, ids, places."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive.guids import GROUP
from hookean_canvas.definitions import layout
from hookean_canvas.definitions.write import Definition, flat
from hookean_canvas.inspect import lint
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from soak import examples


def line(key: str = "line") -> Definition:
    """Two points, a line, its ends and their distance."""
    d = Definition(key, "A line", "Its length, twice.")
    with d.group("Line", "Move the slider."):
        end = d.point(d.slider("Span [m]", 10, 1, 20), 0, 0)
        drawn = d.native("Line", start_point=d.point(0, 0, 0), end_point=end)
        ends = d.native("End Points", curve=drawn)
    with d.group("Numbers"):
        d.numbers("twice = 2 * a.DistanceTo(b)", {"a": ends["Start"], "b": ends["End"]}, {"twice": "twice the span"})
    return d


def test_a_definition_has_no_faults_and_reads_back_as_drawn(tmp_path: Path) -> None:
    line().save(tmp_path / "line.ghx")
    assert lint.faults(archive.read(tmp_path / "line.ghx")) == []
    found = graph.read(tmp_path / "line.ghx")
    assert found.name == "A line"
    wires = {(start.label, out.nickname, end.label, port.nickname) for start, out, end, port in found.wires()}
    assert wires == {
        ("Span [m]", "Span [m]", "Pt", "X"),
        ("Pt", "Pt", "Ln", "A"),
        ("Pt", "Pt", "Ln", "B"),
        ("Ln", "L", "End", "C"),
        ("End", "S", "Numbers", "a"),
        ("End", "E", "Numbers", "b"),
        ("Numbers", "twice", "twice the span", "twice the span"),
    }
    assert [group.title for group in found.groups] == ["Line", "Numbers"]
    assert [len(group.members) for group in found.groups] == [6, 2]


def test_the_same_calls_write_the_same_bytes_and_another_key_other_ids(tmp_path: Path) -> None:
    for name, key in (("a", "line"), ("b", "line"), ("c", "other")):
        line(key).save(tmp_path / f"{name}.ghx")
    a, b, c = (graph.read(tmp_path / f"{name}.ghx") for name in "abc")
    assert (tmp_path / "a.ghx").read_bytes() == (tmp_path / "b.ghx").read_bytes()
    ids = [{g.id, *(port.id for node in g.nodes for port in node.inputs + node.outputs)} for g in (a, c)]
    assert len(ids[0]) == len(ids[1]) and not ids[0] & ids[1]
    assert b.id == a.id


def test_xml_and_binary_hold_the_same_definition(tmp_path: Path) -> None:
    line().save(tmp_path / "line.ghx")
    line().save(tmp_path / "line.gh")
    assert archive.read(tmp_path / "line.gh") == archive.read(tmp_path / "line.ghx")


def test_boxes_do_not_overlap_wires_lead_right_and_groups_stand_apart(tmp_path: Path) -> None:
    line().save(tmp_path / "line.ghx")
    found = graph.read(tmp_path / "line.ghx")
    boxes = [node.bounds for node in found.nodes if node.bounds]
    assert len(boxes) == len(found.nodes)
    assert not any(overlap(a, b) for i, a in enumerate(boxes) for b in boxes[:i])
    for start, _, end, _ in found.wires():
        assert start.bounds and end.bounds
        assert start.bounds[0] + start.bounds[2] < end.bounds[0]
    places = {node.id: node.bounds for node in found.nodes}
    first, second = ([places[key] for key in group.members] for group in found.groups)
    assert max(x + width for x, _, width, _ in first) < min(x for x, _, _, _ in second)


def overlap(a, b) -> bool:
    return a[0] < b[0] + b[2] and b[0] < a[0] + a[2] and a[1] < b[1] + b[3] and b[1] < a[1] + a[3]


def test_wrong_names_are_refused_with_the_right_ones() -> None:
    d = Definition("wrong", "Wrong", "Names.")
    point = d.point(0, 0, 0)
    with pytest.raises(KeyError, match="it has start_point, end_point"):
        d.native("Line", begin=point)
    ends = d.native("End Points", curve=point)
    with pytest.raises(KeyError, match="it has Start, End"):
        ends["Middle"]
    with pytest.raises(KeyError, match="select one of Start, End"):
        d.native("Line", start_point=ends)


def test_a_number_given_to_a_domain_is_the_domain_from_0_to_it() -> None:
    """Grasshopper's own conversion; Range over it in 4 steps, and Random without one over 0 to 1."""
    d = Definition("domain", "Domain", "A number as a domain.")
    d.panel("steps", d.native("Range", domain=10, steps=4))
    d.panel("random", d.native("Random", number=50))
    panels = Canvas(graph.of(d.archive())).run().panels
    assert panels["steps"].values_in_order() == [0.0, 2.5, 5.0, 7.5, 10.0]
    assert 0.0 <= min(panels["random"].values_in_order()) < 0.2 < 0.8 < max(panels["random"].values_in_order()) <= 1.0


def test_a_number_is_refused_by_an_input_that_holds_none() -> None:
    d = Definition("number", "Number", "A number as a curve.")
    with pytest.raises(TypeError, match="Length, curve: 2 is a number, and this input takes a curve"):
        d.native("Length", curve=2)


def test_an_input_can_flatten_what_reaches_it() -> None:
    d = Definition("flat", "Flat", "Modifiers.")
    d.script("Count", "n = len(x)", {"x": flat(d.point(0, 0, 0), d.point(1, 0, 0))}, ["n"], lists=["x"])
    found = graph.of(d.archive())
    [script] = [node for node in found.nodes if node.label == "Count"]
    assert script.inputs[0].mapping == 1 and len(script.inputs[0].sources) == 2


def test_what_is_no_definition_is_refused_by_name(tmp_path: Path) -> None:
    archive.write(archive.Chunk("Root"), tmp_path / "empty.ghx")
    with pytest.raises(InputError, match="not a Grasshopper definition"):
        graph.read(tmp_path / "empty.ghx")


def test_wires_in_a_circle_are_refused_with_the_objects_on_it() -> None:
    found = graph.of(line().archive())
    wires = list(found.wires())
    wires[1][3].sources.append(wires[1][0].outputs[0].id)
    pt = next(node for node in found.nodes if node.label == "Pt")
    pt.inputs[1].sources.append(next(node for node in found.nodes if node.label == "End").outputs[0].id)
    with pytest.raises(InputError, match=r"run in a circle through .*End.*Pt"):
        found.ordered()


def test_groups_are_objects_after_all_others() -> None:
    objects = line().archive().chunk("Definition").chunk("DefinitionObjects")
    kinds = [chunk.value("GUID") == GROUP for chunk in objects.chunks]
    assert kinds == sorted(kinds) and objects.value("ObjectCount") == len(objects.chunks)


sizes = st.tuples(st.floats(20, 200), st.floats(20, 120))


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(sizes, min_size=2, max_size=14), st.data())
def test_any_wiring_is_laid_out_left_to_right_without_overlaps(measures, data) -> None:
    boxes: layout.Boxes = {i: layout.Box(*size) for i, size in enumerate(measures)}
    pairs = st.tuples(st.integers(0, len(measures) - 1), st.integers(0, len(measures) - 1))
    links = [layout.Link(a, b, 10.0, 10.0) for a, b in data.draw(st.lists(pairs, max_size=20)) if a < b]
    cut = data.draw(st.integers(0, len(measures)))
    layout.arrange(boxes, links, [block for block in (range(cut), range(cut, len(measures))) if block])
    placed = [(box.x, box.y, box.width - 1e-6, box.height - 1e-6) for box in boxes.values()]
    assert not any(overlap(a, b) for i, a in enumerate(placed) for b in placed[:i])
    for link in links:
        assert boxes[link.start].x + boxes[link.start].width < boxes[link.end].x


def test_two_strands_are_laid_out_without_a_crossing() -> None:
    boxes: layout.Boxes = {name: layout.Box(60.0, 40.0) for name in ["a1", "b1", "a2", "b2", "a3", "b3", "end"]}
    names = [("a1", "a2"), ("b1", "b2"), ("b2", "b3"), ("a2", "a3"), ("b3", "end"), ("a3", "end")]
    enters = {"b3": 10.0, "a3": 30.0}  # the strand drawn first enters lower
    links = [layout.Link(a, b, 20.0, enters.get(a, 20.0) if b == "end" else 20.0) for a, b in names]
    layout.arrange(boxes, links, [])
    assert layout.crossings(boxes, links) == 0
