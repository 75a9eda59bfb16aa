"""Objects that hold numbers in chunks of their own: graph mappers, gene pools, digit scrollers, recorders."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.native_values import near
from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import DIGIT_SCROLLER, GENE_POOL, GRAPH_MAPPER
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.write import Made
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.mapping import BEZIER, bezier_at


def held(d: Kangaroo, guid: Any, name: str, source: Any = None) -> Made:
    """An object that is an input and an output in one, as Grasshopper writes its special ones."""
    made = d.parameter("Number", name, source=source)
    object.__setattr__(made, "guid", guid)
    made.container.put("Name", Type.STRING, name)
    return made


def found(d: Kangaroo) -> list[Any]:
    return Canvas(graph.of(d.archive())).run(20.0).panels["found"].values_in_order()


def drawn(mapper: Chunk, grips: list[tuple[float, float]], names: str) -> None:
    """A Bézier curve in a Graph Mapper, its grips under names with {i} and {axis}."""
    local = mapper.add("LocalGraph")
    for name, value in (("X0", 0.0), ("X1", 2.0), ("Y0", 10.0), ("Y1", 20.0)):
        local.put(name, Type.DOUBLE, value)
    curve = local.add("Graph").put("container_id", Type.GUID, BEZIER)
    for i, grip in enumerate(grips):
        for axis, value in zip("XY", grip, strict=True):
            curve.put(names.format(i=i, axis=axis), Type.DOUBLE, float(value))


@pytest.mark.parametrize("names", ["P{i}{axis}", "{axis}{i}", "C{i}.{axis}"])
def test_a_graph_mapper_gives_the_height_of_its_curve(names: str) -> None:
    """Grips at 0, 1/3, 2/3, 1 make x the parameter t, and heights 0, 0, 0, 1 make t^3: from 0..2 to 10 + 10 (x/2)^3."""
    d = Kangaroo("mapper", "Mapper", "Numbers through a curve.")
    mapper = held(d, GRAPH_MAPPER, "Graph Mapper", d.parameter("Number", "x", [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0]))
    drawn(mapper.container, [(0, 0), (1 / 3, 0), (2 / 3, 0), (1, 1)], names)
    d.panel("found", mapper)
    assert near(found(d), [10.0, 10.0, 10.0 + 10.0 / 64, 11.25, 20.0, 20.0])


def test_a_graph_mapper_is_read_as_files_of_grasshopper_have_it() -> None:
    """The domains in a chunk of their own, the kind by its name, and grips cpx and cpy with indices."""
    d = Kangaroo("mapper", "Mapper", "Numbers through a curve.")
    mapper = held(d, GRAPH_MAPPER, "Graph Mapper", d.parameter("Number", "x", [0.0, 1.0, 2.0]))
    local = mapper.container.add("LocalGraph")
    domain = local.add("Domain")
    for name, value in (("x0", 0.0), ("x1", 2.0), ("y0", 10.0), ("y1", 20.0)):
        domain.put(name, Type.DOUBLE, value)
    curve = local.add("Graph").put("container_name", Type.STRING, "Bezier")
    for i, grip in enumerate([(0, 0), (1 / 3, 0), (2 / 3, 0), (1, 1)]):
        curve.put("cpx", Type.DOUBLE, float(grip[0]), i).put("cpy", Type.DOUBLE, float(grip[1]), i)
    d.panel("found", mapper)
    assert near(found(d), [10.0, 11.25, 20.0])


def test_the_height_of_a_curve_is_that_of_the_point_with_this_x() -> None:
    grips = np.array([(0.0, 0.2), (0.7, 0.1), (0.9, 0.95), (1.0, 0.6)])
    for t in np.linspace(0.01, 0.99, 9):
        weights = np.array([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
        x, y = weights @ grips
        assert bezier_at(grips, float(x)) == pytest.approx(y, abs=1e-12)


@pytest.mark.parametrize("fault", ["other kind", "three grips", "ends inside", "no curve"])
def test_a_graph_mapper_that_cannot_be_read_is_named(fault: str) -> None:
    d = Kangaroo("mapper", "Mapper", "Numbers through a curve.")
    mapper = held(d, GRAPH_MAPPER, "Graph Mapper", d.parameter("Number", "x", [0.5]))
    grips = [(0.1 if fault == "ends inside" else 0, 0), (0.3, 0), (0.6, 0), (1, 1)]
    if fault != "no curve":
        drawn(mapper.container, grips[: 3 if fault == "three grips" else 4], "P{i}{axis}")
    if fault == "other kind":
        local = mapper.container.chunk("LocalGraph")
        assert local is not None
        local.chunks[0].put("container_id", Type.GUID, GENE_POOL)
    d.panel("found", mapper)
    with pytest.raises(InputError, match="1 x Graph Mapper: the kind of its curve is not known"):
        found(d)


@pytest.mark.parametrize(("decimals", "expected"), [(2, [0.25, 50.13, 75.0]), (0, [0, 50, 75])])
def test_a_gene_pool_gives_its_genes_rounded_to_its_decimals(decimals: int, expected: list[float]) -> None:
    d = Kangaroo("pool", "Pool", "Numbers of a pool.")
    pool = held(d, GENE_POOL, "Gene Pool")
    data = pool.container.add("GeneData").put("Count", Type.INT32, 3).put("Decimals", Type.INT32, decimals)
    for i, value in enumerate(("0.25", "50.126", "75")):
        data.put("Value", Type.DECIMAL, Decimal(value), i)
    d.panel("found", pool)
    assert found(d) == expected and type(found(d)[0]) is type(expected[0])


def test_a_digit_scroller_gives_its_value_or_is_named() -> None:
    d = Kangaroo("scroller", "Scroller", "A number.")
    scroller = held(d, DIGIT_SCROLLER, "Digit Scroller")
    d.panel("found", scroller)
    with pytest.raises(InputError, match="1 x Digit Scroller: how files store its values is not published"):
        found(d)
    scroller.container.add("Scroller").put("Value", Type.DECIMAL, Decimal("12.5")).put("Digits", Type.INT32, 8)
    assert found(d) == [12.5]


def test_a_slider_whose_numbers_are_decimals_has_its_value() -> None:
    d = Kangaroo("slider", "Slider", "A number.")
    slider = d.slider("x", 3.25, 0, 10, 2)
    held_in = slider.container.chunk("Slider")
    assert held_in is not None
    held_in.put("Value", Type.DECIMAL, Decimal("7.25"))
    d.panel("found", slider)
    assert found(d) == [7.25]


def test_a_recorder_hands_on_what_it_gets() -> None:
    d = Kangaroo("recorder", "Recorder", "Numbers through a recorder.")
    d.panel("found", held(d, containers.UUID(int=5), "Data Recorder", d.parameter("Number", "x", [1.0, 2.0])))
    assert found(d) == [1.0, 2.0]
