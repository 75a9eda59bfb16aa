"""Sheets of cutting patterns, read by independent readers: ezdxf, an XML parser, rhino3dm."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import rhino3dm

import hookean
from hookean.errors import InputError
from hookean.files.sheets import LAYERS, drawing, write_sheets
from hookean.values.mesh import Mesh
from hookean.workshop.patterns import Patterns


@pytest.fixture(scope="module")
def patterns() -> Patterns:
    """A saddle of 6 x 6 quads in three strips."""
    side = np.linspace(0.0, 6.0, 7)
    points = np.array([[a, b, 0.1 * a * b] for a in side for b in side])
    number = np.arange(49).reshape(7, 7)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return hookean.cutting_patterns(Mesh(points, faces), rows=2, compensation=(0.01, 0.02), allowance=0.05)


def test_the_drawing_has_every_strip_once(patterns: Patterns) -> None:
    """Outlines keep their shape, and no two strips overlap."""
    lines, labels = drawing(patterns)
    cuts = [line for line in lines if line.layer == "cut"]
    assert [line.name for line in cuts] == ["S1", "S2", "S3"] == [t.text for t in labels if t.layer == "labels"]
    for line, strip in zip(cuts, patterns.strips, strict=True):
        np.testing.assert_allclose(np.diff(line.points, axis=0), np.diff(strip.cut, axis=0), atol=1e-12)
    for below, above in pairwise(cuts):
        assert below.points[:, 1].max() < above.points[:, 1].min()
    assert sum(line.layer == "marks" for line in lines) == sum(len(strip.marks) for strip in patterns.strips) == 28


def test_dxf_is_the_drawing(patterns: Patterns, tmp_path: Path) -> None:
    write_sheets(patterns, tmp_path / "sheet.dxf")
    read = ezdxf.readfile(tmp_path / "sheet.dxf")
    assert read.header["$INSUNITS"] == 6  # metres
    assert not read.audit().errors
    assert set(LAYERS) <= {layer.dxf.name for layer in read.layers}
    lines, labels = drawing(patterns)
    found = list(read.modelspace().query("LWPOLYLINE"))
    assert len(found) == len(lines)
    for entity, line in zip(found, lines, strict=True):
        assert (entity.dxf.layer, entity.closed) == (line.layer, line.closed)
        np.testing.assert_allclose([p[:2] for p in entity.get_points()], line.points, rtol=1e-15, atol=1e-15)
    texts = list(read.modelspace().query("TEXT"))
    assert [t.dxf.text for t in texts] == [label.text for label in labels]
    np.testing.assert_allclose([tuple(t.dxf.insert)[:2] for t in texts], [label.point for label in labels], atol=1e-12)


def test_svg_is_the_drawing_in_true_size(patterns: Patterns, tmp_path: Path) -> None:
    write_sheets(patterns, tmp_path / "sheet.svg")
    root = ElementTree.parse(tmp_path / "sheet.svg").getroot()
    space = "{http://www.w3.org/2000/svg}"
    lines, labels = drawing(patterns)
    every = np.concatenate([line.points for line in lines])
    low, high = every.min(axis=0), every.max(axis=0)
    box = [float(v) for v in root.get("viewBox", "").split()]
    np.testing.assert_allclose(box, [0.0, 0.0, *(high - low)], rtol=1e-12)
    assert float(root.get("width", "").removesuffix("mm")) == pytest.approx(1000.0 * box[2], rel=1e-12)
    found = {group.get("id"): list(group) for group in root}
    assert list(found) == list(LAYERS)
    for layer in LAYERS:
        shapes = [child for child in found[layer] if child.tag != f"{space}text"]
        wanted = [line for line in lines if line.layer == layer]
        assert [s.find(f"{space}title").text for s in shapes] == [line.name for line in wanted]
        for shape, line in zip(shapes, wanted, strict=True):
            points = np.array([[float(c) for c in p.split(",")] for p in shape.get("points", "").split()])
            np.testing.assert_allclose(points * [1, -1] + [low[0], high[1]], line.points, atol=1e-12)
            assert shape.tag == f"{space}{'polygon' if line.closed else 'polyline'}"
        texts = [child.text for child in found[layer] if child.tag == f"{space}text"]
        assert texts == [label.text for label in labels if label.layer == layer]


def test_3dm_is_the_drawing(patterns: Patterns, tmp_path: Path) -> None:
    write_sheets(patterns, tmp_path / "sheet.3dm")
    read = rhino3dm.File3dm.Read(str(tmp_path / "sheet.3dm"))
    assert read.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Meters
    assert [layer.Name for layer in read.Layers if layer.Name in LAYERS] == list(LAYERS)
    lines, _ = drawing(patterns)
    names = {layer.Index: layer.Name for layer in read.Layers}
    curves = [o for o in read.Objects if isinstance(o.Geometry, rhino3dm.Curve)]
    assert len(curves) == len(lines)
    for found, line in zip(curves, lines, strict=True):
        assert (names[found.Attributes.LayerIndex], found.Attributes.Name) == (line.layer, line.name)
        start, end = found.Geometry.PointAtStart, found.Geometry.PointAtEnd
        np.testing.assert_array_equal([start.X, start.Y, start.Z], [*line.points[0], 0.0])
        last = line.points[0] if line.closed else line.points[-1]
        np.testing.assert_array_equal([end.X, end.Y, end.Z], [*last, 0.0])
    dots = [o.Attributes.Name for o in read.Objects if isinstance(o.Geometry, rhino3dm.Point)]
    assert dots == ["S1", "S2", "S3"]


@pytest.mark.parametrize("ending", ["dxf", "svg", "3dm"])
def test_the_same_patterns_give_the_same_bytes(patterns: Patterns, tmp_path: Path, ending: str) -> None:
    write_sheets(patterns, tmp_path / f"a.{ending}")
    write_sheets(patterns, tmp_path / f"b.{ending}")
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_other_endings_and_missing_packages_are_one_sentence(
    patterns: Patterns, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(InputError, match=r"has an unknown ending; end the name in .3dm, .dxf, .svg"):
        write_sheets(patterns, tmp_path / "sheet.pdf")
    monkeypatch.setitem(__import__("sys").modules, "ezdxf", None)
    with pytest.raises(InputError, match=r"needs the package ezdxf; install it with pip install 'hookean\[exchange\]'"):
        write_sheets(patterns, tmp_path / "sheet.dxf")
    assert not list(tmp_path.iterdir())
