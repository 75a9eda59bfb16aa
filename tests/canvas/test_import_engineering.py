"""K2Engineering's components translated: numbers in kN, kNm and MPa that statics and its own formulas give."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from canvas.kangaroo_samples import SOLVER, Kangaroo
from canvas.test_import_run import ran
from hookean_canvas.archive.parts import parts
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.engineering import ENGINEERING, REASONS
from hookean_canvas.kangaroo.ids import COMPONENTS, key
from hookean_canvas.kangaroo.table import markdown

pytestmark = pytest.mark.usefixtures("home")

NAMED = {known.name: guid for guid, known in COMPONENTS.items() if known.generation == "engineering"}
E, G = 210000.0, 81000.0


def part(d: Kangaroo, name: str, outputs: str, typed: Any = (), **wires: Any) -> Any:
    """One of its components; `typed`: inputs with what is typed into them, others by their wires."""
    given = [*typed, *((title, None) for title in wires if title not in dict(typed))]
    return d.kangaroo(name, given, outputs.split(), guid=NAMED[name], **{k.lower(): v for k, v in wires.items()})


def solved(d: Kangaroo, goals: list[Any]) -> Any:
    return d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))


def picked(d: Kangaroo, name: str, source: Any, rows: list[int]) -> Any:
    """Items of a list by their numbers, as people take outputs of the solver apart."""
    return d.native("List Item", name, list=source, index=d.parameter("Integer", f"{name} rows", rows))["Item"]


def shown(outcome: Any, panel: str) -> Any:
    values = outcome.panels[panel].values_in_order()
    return np.array([[v.X, v.Y, v.Z] if hasattr(v, "X") else v for v in values], dtype=float)


def test_every_component_of_the_public_files_is_translated_or_has_its_reason() -> None:
    """The 30 components found in public definitions; those that draw or need another plug-in's mesh stay."""
    left = {key(name) for name in NAMED} - set(ENGINEERING) - set(REASONS)
    assert not left
    assert sum(key(name) in ENGINEERING for name in NAMED) == 23
    assert "| K2Engineering | bar | Springs, by a script |" in markdown()


def test_a_truss_has_the_forces_stresses_and_reactions_of_statics_in_kn_and_mpa(tmp_path: Path) -> None:
    """Two bars 5 m long over 6 m with 10 kN at their joint: N = P / (2 cos a) = 6.25 kN, each support takes P / 2.

    Strain N / EA = 3e-5, by which the angles differ from the drawn ones.
    """
    d = Kangaroo("truss", "Truss", "Bars")
    joint, ends = d.point(0, 0, -4), [d.point(-3, 0, 0), d.point(3, 0, 0)]
    bars = part(
        d,
        "Bar",
        "B",
        [("E-Modulus", E), ("Area", 1000.0)],
        Line=[d.native("Line", start_point=p, end_point=joint) for p in ends],
    )
    supports = part(d, "Support", "SimpleSupportGoal", [("XFixed", True), ("Strength", 1e15)], PinnedSupportPt=ends)
    load = part(d, "Load", "LoadGoal", [("NodalForce", (0.0, 0.0, -10000.0))], Point=joint)
    solver = solved(d, [bars, supports, load])
    output = part(d, "BarOutput", "Line AxialForce AxialStress", BarData=picked(d, "bars", solver["O"], [0, 1]))
    held = part(d, "SupportOutput", "SupportPt ReactionForce", SupportData=picked(d, "held", solver["O"], [2, 3]))
    d.panel("force", output["AxialForce"])
    d.panel("stress", output["AxialStress"])
    d.panel("reaction", held["ReactionForce"])
    root, report = kangaroo.translate(d.archive())
    assert not report.stays and not report.lost, report.text()
    held_values = [part.container.value("UserText") for part in parts(root) if part.label == "Length unit"]
    assert held_values == ["m"]  # whatever the unit of the document
    outcome = ran(d, tmp_path)
    np.testing.assert_allclose(shown(outcome, "force"), [6.25, 6.25], rtol=1e-4)
    np.testing.assert_allclose(shown(outcome, "stress"), [6.25, 6.25], rtol=1e-4)
    np.testing.assert_allclose(shown(outcome, "reaction"), [[-3.75, 0, 5], [3.75, 0, 5]], rtol=1e-4, atol=1e-9)


def test_cables_keep_their_pretension_and_rods_carry_the_moment_of_statics(tmp_path: Path) -> None:
    """A straight cable held at its ends has its pre-tension; a rod over 2 m with 0.5 N has P L / 4 in its middle."""
    d = Kangaroo("rod", "Rod", "Rods and cables")
    points = [d.point(0.25 * i, 0, 0) for i in range(9)]
    lines = [d.native("Line", start_point=points[i], end_point=points[i + 1]) for i in range(8)]
    bars = part(d, "Bar", "B", [("E-Modulus", E), ("Area", 10.0)], Line=lines)
    typed = [("E-Modulus", E), ("Inertia", 1000.0), ("z-distance", 5.0), ("RestAngleOption", 0)]
    rods = part(d, "Rod", "R", typed, LineA=lines[:-1], LineB=lines[1:])
    ropes = [d.point(x, 5, 0) for x in (0, 1, 3)]
    ropes = [d.native("Line", start_point=p, end_point=q) for p, q in pairwise(ropes)]
    cables = part(d, "Cable", "Cable", [("E-Modulus", E), ("Area", 10.0), ("PreTension", 700.0)], Line=ropes)
    held = [points[0], d.point(0, 5, 0), d.point(3, 5, 0)]
    supports = part(d, "Support", "SimpleSupportGoal", PinnedSupportPt=held)
    roller = part(d, "Support", "SimpleSupportGoal ", [("XFixed", False)], PinnedSupportPt=points[-1])
    load = part(d, "Load", "LoadGoal", [("NodalForce", (0.0, 0.0, -0.5))], Point=points[4])
    solver = solved(d, [rods, cables, bars, supports, roller, load])
    bent = part(d, "RodOutput", "Plane BendingMoment BendingStress", RodData=picked(d, "rods", solver["O"], [3]))
    rope = part(d, "BarOutput", "Line AxialForce", BarData=picked(d, "cables", solver["O"], [7, 8]))
    d.panel("moment", bent["BendingMoment"])
    d.panel("stress", bent["BendingStress"])
    d.panel("tension", rope["AxialForce"])
    outcome = ran(d, tmp_path)
    # deflection P L^3 / 48 EI = 0.4 mm: the arms are the drawn ones to 1e-6
    np.testing.assert_allclose(shown(outcome, "moment"), [0.25e-3], rtol=1e-3)
    np.testing.assert_allclose(shown(outcome, "stress"), [250.0 * 5.0 / 1000.0], rtol=1e-3)
    np.testing.assert_allclose(shown(outcome, "tension"), [0.7, 0.7], rtol=1e-6)


def test_beams_report_the_moments_that_k2engineering_would_from_the_same_planes(tmp_path: Path) -> None:
    """Its source's M = EI / L (4 a + 2 b) and GIt / L t, of the planes that come out, are what My0 ... Mt report.

    An L-shaped frame bends and twists; P = 100 N at the tip gives M = P L and Mt = P b at the support.
    """
    d = Kangaroo("frame", "Frame", "Beams")
    base, corner, tip = d.point(0, 0, 0), d.point(2, 0, 0), d.point(2, 1, 0)
    lines = [d.native("Line", start_point=p, end_point=q) for p, q in ((base, corner), (corner, tip))]
    planes = part(d, "BeamOrientation", "StartPlane EndPlane", Line=lines)
    section = part(d, "RectangularCS", "A Iy Iz It", [("Width", 80.0), ("Height", 120.0), ("Thickness", 0.0)])
    beams = part(
        d, "Beam", "Beam", [("E-modulus", E), ("G-modulus", G)], StartPlane=planes["StartPlane"],
        EndPlane=planes["EndPlane"], **{name: section[name] for name in ("A", "Iy", "Iz", "It")},
    )  # fmt: skip
    support = part(d, "Support6DOF", "Support6DOFGoal", [("Strength", 1e12)], SupportPt=base)
    load = part(d, "Load", "LoadGoal", [("NodalForce", (0.0, 60.0, -100.0))], Point=tip)
    solver = solved(d, [beams, support, load])
    names = "P0 P1 N Vy Vz Mt My0 Mz0 My1 Mz1"
    output = part(d, "BeamOutput", names, BeamData=picked(d, "beams", solver["O"], [0, 1]))
    held = part(
        d, "Support6DOFOutput", "SupportPlane ReactionForce ReactionMoment",
        Support6DOFData=picked(d, "held", solver["O"], [2]),
    )  # fmt: skip
    for name in (*names.split(),):
        d.panel(name, output[name])
    for name in ("A", "Iy", "Iz", "It"):
        d.panel(f"section {name}", section[name])
    d.panel("RF", held["ReactionForce"])
    d.panel("RM", held["ReactionMoment"])
    outcome = ran(d, tmp_path)
    iy, iz, it = (shown(outcome, f"section {name}")[0] * 1e-12 for name in ("Iy", "Iz", "It"))
    assert math.isclose(iy, 0.08 * 0.12**3 / 12) and math.isclose(iz, 0.12 * 0.08**3 / 12)
    forces = {name: shown(outcome, name) for name in names.split()[2:]}
    for i, length in enumerate((2.0, 1.0)):
        first, last = (outcome.panels[name].values_in_order()[i] for name in ("P0", "P1"))
        vectors = [np.array([[a.X, a.Y, a.Z] for a in (p.Origin, p.XAxis, p.YAxis)]) for p in (first, last)]
        (o0, y0, z0), (o1, y1, z1) = vectors
        along = (o1 - o0) / np.linalg.norm(o1 - o0)
        a, b, c, e = z0 @ along, z1 @ along, -y0 @ along, -y1 @ along
        kilo = E * 1e3 / length
        expected = {
            "My0": kilo * iy * (4 * a + 2 * b), "My1": kilo * iy * (4 * b + 2 * a),
            "Mz0": kilo * iz * (4 * c + 2 * e), "Mz1": kilo * iz * (4 * e + 2 * c),
            "Mt": G * 1e3 * it / length * (y0 @ z1 - y1 @ z0) / 2,
        }  # fmt: skip
        for name, value in expected.items():
            assert forces[name][i] == pytest.approx(value, abs=1e-5), (name, i)
    assert abs(forces["Mt"][0]) == pytest.approx(0.1, rel=1e-3)  # P b
    assert abs(forces["My0"][0]) == pytest.approx(0.2, rel=1e-3)  # P L
    np.testing.assert_allclose(shown(outcome, "RF"), [[0, -0.06, 0.1]], atol=1e-6)
    np.testing.assert_allclose(shown(outcome, "RM"), [[0.1, -0.2, -0.12]], atol=1e-4)


def test_beams_between_planes_that_lean_are_bent_in(tmp_path: Path) -> None:
    """Two beams of a flat arch in a plane that leans, on planes across its mean direction in the middle and across each
    beam at its ends, all held: M = EI / L (4 a + 2 b) of the angles between planes and chords, in both the same sense.
    """
    d = Kangaroo("arch", "Arch", "Beams bent in")
    up, across, rise = np.array([0.0, 0.6, 0.8]), (0.0, 0.8, -0.6), 0.01
    corners = [np.zeros(3), np.array([1.0, 0.0, 0.0]) + rise * up, np.array([2.0, 0.0, 0.0])]
    nodes = [d.point(*map(float, corner)) for corner in corners]
    across_x = d.parameter("Vector", "across", [across])

    def leaning(name: str, node: Any, axis: np.ndarray) -> Any:
        y = d.parameter("Vector", name, [tuple(map(float, axis))])
        return d.native("Construct Plane", name, **{"origin": node, "x-axis": across_x, "y-axis": y})

    first, last = up - rise * np.array([1.0, 0.0, 0.0]), up + rise * np.array([1.0, 0.0, 0.0])
    planes = [leaning(*one) for one in zip("abc", nodes, (first, up, last), strict=True)]
    typed = [("E-modulus", E), ("G-modulus", G), ("A", 100.0), ("Iy", 1e4), ("Iz", 2e4), ("It", 1e4)]
    beams = part(d, "Beam", "Beam", typed, StartPlane=planes[:2], EndPlane=planes[1:])
    support = part(d, "Support6DOF", "Support6DOFGoal", [("Strength", 1e12)], SupportPt=nodes)
    solver = solved(d, [beams, support])
    output = part(d, "BeamOutput", "My0 Mz0 My1 Mz1", BeamData=picked(d, "beams", solver["O"], [0, 1]))
    for name in ("My0", "Mz0", "My1", "Mz1"):
        d.panel(name, output[name])
    outcome = ran(d, tmp_path)
    length = math.hypot(1.0, rise)
    bend = E * 1e6 * 1e4 * 1e-12 / length * rise / length * 1e-3  # kN m for a rotation by the slope
    # at rest to 1e-3 of the forces, of which both beams and the support have a part in each moment
    np.testing.assert_allclose(shown(outcome, "My0"), [2.0 * bend, -4.0 * bend], rtol=4e-3)
    np.testing.assert_allclose(shown(outcome, "My1"), [4.0 * bend, -2.0 * bend], rtol=4e-3)
    np.testing.assert_allclose([shown(outcome, "Mz0"), shown(outcome, "Mz1")], 0.0, atol=4e-3 * bend)


def test_what_calculates_gives_the_numbers_of_its_formulas(tmp_path: Path) -> None:
    """A tube's section, weights with 9.82 m/s2, the largest displacement with its sign, snow, wind and pretension."""
    d = Kangaroo("tools", "Tools", "Numbers")
    steel = part(d, "Materials", "Density Strength", [("MaterialIndex", 0)])
    tube = part(d, "CircularCS", "A I z It", [("Diameter", 100.0), ("Thickness", 10.0)])
    lines = [d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(x, 0, z)) for x, z in ((3, 0), (0, 4))]
    nodes = part(d, "BarLength", "Points NodalLengths", Bars=lines)
    weight = part(
        d, "BarSelfweight", "NodalSelfweight", NodalLengths=nodes["NodalLengths"], CrossSectionArea=tube["A"],
        MaterialDensity=steel["Density"],
    )  # fmt: skip
    before, after = d.point(0, 0, 0), d.point(0.001, -0.002, 0)
    moved = part(
        d, "Displacements", "TotalDisplacements MaximumDisplacementY", InitialPositions=before, FinalPositions=after
    )
    normals = d.parameter("Vector", "normals", [(0.0, 0.0, 2.0), (0.0, 0.0, -2.0)])
    snow = part(
        d, "MeshSnowLoad", "NodalSnowLoad", [("Snow", (0.0, 0.0, -0.5)), ("Option", True)], VertexNormals=normals
    )
    wind = part(
        d, "MeshWindLoad", "NodalWindLoad", [("Wind", (0.0, 0.0, -0.5)), ("Option", True)], VertexNormals=normals
    )
    rest, length = d.parameter("Number", "rest", [1.0, 2.0]), d.parameter("Number", "length", [1.1, 2.2])
    typed = [("Strength", 50.0), ("MaxPretension", 300.0)]
    tension = part(d, "Pretension", "PTDistribution", typed, RestLength=rest, FFLength=length)
    shows = {
        "I": tube["I"], "It": tube["It"], "z": tube["z"], "lengths": nodes["NodalLengths"],
        "weight": weight["NodalSelfweight"],
        "y": moved["MaximumDisplacementY"], "snow": snow["NodalSnowLoad"], "wind": wind["NodalWindLoad"],
        "tension": tension["PTDistribution"],
    }  # fmt: skip
    for name, source in shows.items():
        d.panel(name, source)
    outcome = ran(d, tmp_path)
    area, inertia = math.pi * (50.0**2 - 40.0**2), math.pi / 4 * (50.0**4 - 40.0**4)
    expected: dict[str, Any] = {
        "I": [inertia], "It": [2 * inertia], "z": [50.0], "lengths": [3.5, 1.5, 2.0], "y": [-2.0],
        "weight": [[0, 0, -9.82 * 7850e-6 * area * half / 1] for half in (3.5, 1.5, 2.0)],
        "snow": [[0, 0, -1000.0], [0, 0, 0]], "wind": [[0, 0, -1000.0], [0, 0, -1000.0]], "tension": [150.0, 300.0],
    }  # fmt: skip
    for name, values in expected.items():
        np.testing.assert_allclose(shown(outcome, name), values, rtol=1e-12, atol=1e-12, err_msg=name)
