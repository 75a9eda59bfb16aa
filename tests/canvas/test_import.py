"""Definitions made for Kangaroo, translated: what is swapped, what stays, and that nothing of it is silent."""

from __future__ import annotations

import base64
from collections.abc import Callable
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from canvas.archives import samples
from canvas.kangaroo_samples import (
    LENGTH,
    PHYSICS,
    SETTINGS,
    SOLVER,
    SPRINGS,
    Kangaroo,
    cable,
    star,
    store,
    tent,
    wires,
)
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Item, Type, guids
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE, CLUSTER, PANEL, PARAMETERS, PYTHON3_SCRIPT
from hookean_canvas.archive.parts import Part, Rectangle, bounds_of, inputs, outputs, parts, sources
from hookean_canvas.command import app
from hookean_canvas.definitions import containers
from hookean_canvas.inspect import lint
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.ids import COMPONENTS, Known, libraries, recognised
from hookean_canvas.kangaroo.report import Report
from hookean_canvas.kangaroo.roles import Role, role
from hookean_canvas.kangaroo.streams import copied
from hookean_canvas.kangaroo.swap import FLOATING
from hookean_canvas.kangaroo.table import CLASSIC, SECOND, markdown, swap_of
from serving import SOAK
from soak import sampled


def translated(d: Kangaroo) -> tuple[Chunk, Report]:
    """A translation, after the checks that every one has to pass."""
    before = d.archive()
    after, report = kangaroo.translate(before, "sample.gh")
    assert lint.faults(after) == [] and overlapping(before, after) == []
    assert report.wires == len(wires(before)) == report.kept + len(report.lost) + len(report.idle)
    assert len(wires(before) & wires(after)) <= report.kept <= len(wires(after))
    assert remaining(after) == report.kangaroo - len(report.swapped)
    return after, report


def remaining(root: Chunk) -> int:
    """How many components of Kangaroo a definition holds."""
    definition = root.chunk("Definition")
    assert definition is not None
    return sum(recognised(part.chunk, libraries(definition)) is not None for part in parts(root))


def the(root: Chunk, label: str) -> Part:
    """The one object with that nickname."""
    [found] = [part for part in parts(root) if part.label == label]
    return found


def port(part: Part, name: str) -> Chunk:
    """An input by our name for it."""
    assert part.container is not None
    return next(p for p in inputs(part.container) if str(p.value("NickName")).strip("_") == name)


def behind(root: Chunk, part: Part, name: str) -> list[Part]:
    """What is wired to an input."""
    owners = {p.value("InstanceGuid"): o for o in parts(root) if o.container for p in outputs(o.container)}
    return [owners[source] for source in sources(port(part, name))]


def test_a_classic_definition_is_translated_whole_with_its_ids_groups_and_timer() -> None:
    d = cable()
    before = d.archive()
    after, report = translated(d)
    assert report.complete and remaining(after) == 0 and len(report.swapped) == 3
    assert wires(before) <= wires(after)
    kinds = {part.id: part.guid for part in parts(after)}
    for part in parts(before):
        known = COMPONENTS.get(part.guid) if part.guid else None
        assert kinds[part.id] == (PYTHON3_SCRIPT if known else part.guid)
    assert "Timer is no longer needed" in report.text()


Places = dict[UUID, Rectangle]


def places(root: Chunk) -> Places:
    """Where objects are, by their ids; a parameter that was a component by that of its output."""
    found: Places = {}
    for part in parts(root):
        box = bounds_of(part.container)
        if box is not None and part.container is not None:
            found |= {one: box for one in [part.id, *(p.value("InstanceGuid") for p in outputs(part.container))] if one}
    return found


def meet(a: Rectangle, b: Rectangle) -> bool:
    return all(a[i] < b[i] + b[i + 2] and b[i] < a[i] + a[i + 2] for i in (0, 1))


def overlapping(before: Chunk, after: Chunk) -> list[tuple[str, str]]:
    """Objects that share their place with another one and did not before, and that one; by their labels."""
    boxes = [(part, box) for part in parts(after) if (box := bounds_of(part.container))]
    was = places(before)
    return [
        (part.label, other.label)
        for part, a in boxes
        for other, b in boxes
        if other is not part and meet(a, b)
        and not (part.id in was and other.id in was and meet(was[part.id], was[other.id]))
    ]  # fmt: skip


def test_objects_stay_where_they_stand_where_there_is_room() -> None:
    before = cable().archive()
    for i, part in enumerate(one for one in parts(before) if one.container is not None):
        assert part.container is not None
        containers.place(part.container, (600.0 * (i % 4), 600.0 * (i // 4), 80.0, 50.0))
    after, report = kangaroo.translate(before, "cable.gh")
    old, new = ({one: box[:2] for one, box in places(root).items()} for root in (before, after))
    assert old.items() <= new.items() and not any("were moved" in note for note in report.notes)


@pytest.mark.soak
@settings(max_examples=200 if SOAK else 10, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8)), min_size=12, max_size=12, unique=True))
def test_what_becomes_larger_pushes_others_on_and_nothing_comes_to_overlap(cells: list[tuple[int, int]]) -> None:
    """Objects in cells of a grid at random; each keeps its order with any other that is right of it, or below."""
    d = Kangaroo("cells", "Cells", "Goals side by side.")
    mesh = d.parameter("Mesh", "Mesh")
    typed = (("Mesh", None), ("LengthFactor", 0.5), ("Strength", 10.0))
    goals = [d.kangaroo("EdgeLengths", typed, ["EL"], mesh=mesh) for _ in range(8)]
    d.panel("particles", d.solved(*goals)["V"])
    before = d.archive()
    placed = [part for part in parts(before) if part.container is not None and part.guid != guids.GROUP]
    assert len(placed) == 12  # a note, a mesh, eight goals, a solver, a panel
    for (column, row), part in zip(cells, placed, strict=True):
        assert part.container is not None
        containers.place(part.container, (90.0 * column, 54.0 * row, 80.0, 50.0))
    after, report = kangaroo.translate(before, "cells.gh")
    assert report.whole == 1 and overlapping(before, after) == []
    old, new = places(before), places(after)
    for one, a in old.items():
        for other, b in old.items():
            for i in (0, 1):
                assert a[i] + a[i + 2] > b[i] or new[one][i] < new[other][i]


def test_new_objects_are_placed_where_nothing_is_on_a_crowded_canvas() -> None:
    """Components side by side, as close as people put them, each with values and helpers of its own."""
    d = Kangaroo("crowded", "Crowded", "Many goals.")
    mesh, data = d.parameter("Mesh", "Mesh"), d.parameter("Data", "Data")
    goals = []
    for i in range(6):
        typed = (("LineA", None), ("LineB", None), ("Upper", 1.5 + i), ("Lower", 0.5), ("Strength", 3.0 + i))
        goals.append(d.kangaroo("ClampAngle", typed, ["C"], linea=data, lineb=data))
        volume = (("Mesh", None), ("Volume", 2.0 + i), ("Strength", 3.0))
        goals.append(d.kangaroo("Volume", volume, ["V"], mesh=mesh))
    d.solved(*goals)
    before = d.archive()
    for i, part in enumerate(part for part in parts(before) if part.container is not None):
        assert part.container is not None
        containers.place(part.container, (100.0 * (i % 4), 60.0 * (i // 4), 80.0, 50.0))
    after, report = kangaroo.translate(before, "crowded.gh")
    new = len(parts(after)) - len(parts(before))
    assert report.whole == 1 and new >= 6 * 5 and overlapping(before, after) == []


def test_the_report_on_a_file_of_grasshopper_covers_nothing() -> None:
    for file in samples():
        root = archive.read(file)
        if root.chunk("Definition") is not None:
            after, _ = kangaroo.translate(root, file.name)
            assert overlapping(root, after) == [] and the(after, "Translated for hookean")


@pytest.mark.parametrize("both", [False, True])
def test_points_and_a_solid_become_a_contact_with_it(both: bool) -> None:
    """The solid is the target; that it stays where it is is usual, and the contrary is reported."""
    d = Kangaroo("solid", "Solid", "SolidPointCollide.")
    typed = (("Points", None), ("Solid", None), ("Interior", True), ("Unidirectional", not both), ("Strength", 7.0))
    points, solid = d.parameter("Point", "Points"), d.parameter("Mesh", "Block")
    d.solved(d.kangaroo("SolidPointCollide", typed, ["S"], points=points, solid=solid))
    after, report = translated(d)
    found = the(after, "CollideSolid")
    assert [part.label for part in behind(after, found, "target")] == ["Block"]
    assert [part.label for part in behind(after, found, "point")] == ["Points"]
    assert report.complete == (not both) and ("the solid stays where it is" in report.text()) == both


def test_two_meshes_become_solids_that_collide() -> None:
    """Corners of both, with the number of their mesh; planes that are empty are reported as nothing."""
    d = Kangaroo("solids", "Solids", "RigidBodyCollide.")
    typed = (("MeshA", None), ("MeshB", None), ("PlaneA", None), ("PlaneB", None), ("Strength", 7.0))
    one, other = d.parameter("Mesh", "One"), d.parameter("Mesh", "Other")
    d.solved(d.kangaroo("RigidBodyCollide", typed, ["SolidCollide"], mesha=one, meshb=other))
    after, report = translated(d)
    found, solids = the(after, "RigidCollide"), the(after, "Solids")
    assert [part.id for part in behind(after, found, "point")] == [solids.id]
    assert [part.id for part in behind(after, found, "group")] == [solids.id]
    assert [part.label for part in behind(after, solids, "meshes")] == ["One"]
    assert [part.label for part in behind(after, solids, "others")] == ["Other"]
    assert report.complete and "convex hulls" in report.text()


def test_a_mesh_and_a_plane_become_a_contact_of_its_corners() -> None:
    d = Kangaroo("plane", "Plane", "SolidPlaneCollide.")
    typed = (("Solid", None), ("SolidPlane", None), ("CollisionPlane", None), ("Strength", 7.0))
    solid, plane = d.parameter("Mesh", "Block"), d.parameter("Plane", "Ground")
    d.solved(d.kangaroo("SolidPlaneCollide", typed, ["SolidPlaneCollide"], solid=solid, collisionplane=plane))
    after, report = translated(d)
    found, planes = the(after, "SolidPlaneCollide"), the(after, "Planes")
    assert [part.id for part in behind(after, found, "normal")] == [planes.id]
    assert [part.id for part in behind(after, found, "origin")] == [planes.id]
    assert [part.label for part in behind(after, planes, "planes")] == ["Ground"]
    assert [part.label for part in behind(after, the(after, "Solids"), "meshes")] == ["Block"]
    assert report.complete


@pytest.mark.parametrize(
    ("name", "inputs", "ours", "helper"),
    [("Concentric", "Axis", "Concentric", "Axles"), ("AlignFaces", "Face", "AlignFaces", "Mates")],
)
@pytest.mark.parametrize("flip", [False, True])
def test_mates_take_the_corners_of_what_they_join(name: str, inputs: str, ours: str, helper: str, flip: bool) -> None:
    """Whether normals become the same is kept; an axis has no direction here, which is reported."""
    d = Kangaroo("mates", "Mates", f"{name}.")
    a, b = f"{inputs}A", f"{inputs}B"
    typed = (("PlaneA", None), ("PlaneB", None), (a, None), (b, None), ("Flip", flip), ("Strength", 7.0))
    one, other = d.parameter("Curve", "One"), d.parameter("Curve", "Other")
    d.solved(d.kangaroo(name, typed, [name], **{a.lower(): one, b.lower(): other}))
    after, report = translated(d)
    found, before = the(after, ours), the(after, helper)
    for i in range(1, 7 if name == "AlignFaces" else 5):
        assert [part.id for part in behind(after, found, f"point_{i}")] == [before.id]
    assert report.complete == (name == "AlignFaces" or not flip)


def test_typed_values_are_kept_and_those_that_are_ours_anyway_are_not_repeated() -> None:
    d = Kangaroo("typed", "Typed", "Values in components.")
    line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0))
    d.solved(d.springs(line, {"Stiffness": 750.0, "Plasticity": 0.125}), classic=True)
    after, _ = translated(d)
    springs = the(after, "Springs")
    held = {
        name: [found.container.value("UserText") for found in behind(after, springs, name) if found.container]
        for name in ("stiffness", "damping", "rest_length", "upper_cutoff", "plasticity")
    }
    # 10 and 0 are the defaults of damping and cutoff here too; the rest length's is the start length
    assert held == {
        "stiffness": ["750"],
        "damping": [],
        "rest_length": ["0"],
        "upper_cutoff": [],
        "plasticity": ["0.125"],
    }


def test_typed_lists_and_vectors_go_into_parameters_with_their_branches() -> None:
    d = Kangaroo("lists", "Lists", "More than one value.")
    line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0))
    springs = d.springs(line)
    store(springs.inputs["stiffness"][1], [5.0, 7.5], "{0;2}")
    load = d.kangaroo(
        "UnaryForce",
        (("Point", None), ("Force", (0.0, 50.0, 0.0))),
        ["UnaryForce"],
        classic=True,
        point=d.point(0, 0, 0),
    )
    d.solved(springs, load, classic=True)
    after, _ = translated(d)
    [numbers] = behind(after, the(after, "Springs"), "stiffness")
    [vector] = behind(after, the(after, "UForce"), "force")
    assert (numbers.guid, vector.guid) == (PARAMETERS["Number"], PARAMETERS["Vector"])
    data = numbers.container.chunk("PersistentData")  # type: ignore[union-attr]
    assert data == springs.inputs["stiffness"][1].chunk("PersistentData") and data is not None
    assert data.chunks[0].value("Path") == "{0;2}"


def test_a_negative_cutoff_of_old_springs_is_a_lower_one() -> None:
    d = Kangaroo("cutoff", "Cutoff", "One signed cutoff.")
    old = tuple((n, v) for n, v in SPRINGS if "Cutoff" not in n) + (("Cutoff", -2.5),)
    line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0))
    springs = d.kangaroo(
        "SpringsFromLine",
        old,
        ["Springs"],
        guid=UUID("3ba652e9-f566-441d-8d04-02151edf69b4"),
        classic=True,
        connection=line,
    )
    d.solved(springs, classic=True)
    after, _ = translated(d)
    [held] = behind(after, the(after, "Springs"), "lower_cutoff")
    assert held.container is not None and held.container.value("UserText") == "2.5"
    assert behind(after, the(after, "Springs"), "upper_cutoff") == []


def test_settings_keep_the_floor_and_what_has_no_counterpart_is_told_only_where_someone_changed_it() -> None:
    d = Kangaroo("settings", "Settings", "Floor and friction.")
    made = d.kangaroo("Kangaroo Settings", SETTINGS, ["Settings"], classic=True)
    d.kangaroo("KangarooPhysics", PHYSICS, ["Out"], classic=True, settings=made)
    after, report = translated(d)
    assert report.values == []
    [floor] = behind(after, the(after, "Settings"), "floor")
    assert floor.guid == BOOLEAN_TOGGLE and floor.container is not None and floor.container.value("ToggleValue") is True
    store(made.inputs["staticfriction"][1], [0.25])
    _, report = translated(d)
    assert [where for where, _ in report.values] == ["Kangaroo Settings, StaticFriction = 0.25"]


def test_wires_into_inputs_without_counterpart_are_listed_with_the_reason() -> None:
    _, report = translated(tent())
    assert [wire for wire, _ in report.lost] == ["Threshold > Solver.Threshold"]
    assert "residual" in report.lost[0][1]
    assert not report.complete


@pytest.mark.parametrize("wired", [True, False])
def test_a_solver_that_was_saved_paused_stays_paused(wired: bool) -> None:
    """Its On, wired or typed, is the Engine's."""
    d = Kangaroo("paused", "Paused", "A solver that is off.")
    typed = tuple((name, False if name == "On" and not wired else value) for name, value in SOLVER)
    spring = d.kangaroo("Length(Line)", LENGTH, ["S"], line=d.native("Line", start_point=d.point(0, 0, 0)))
    wires_ = {"on": d.toggle("Switch", False)} if wired else {}
    d.kangaroo("Solver", typed, ["I", "V", "O"], goalobjects=spring, **wires_)
    after, report = translated(d)
    [held] = behind(after, the(after, "Engine"), "on")
    assert held.guid == BOOLEAN_TOGGLE and held.container is not None
    assert held.container.value("ToggleValue") is False and report.complete


@pytest.mark.parametrize(
    ("name", "names", "guid", "helper", "column"),
    [
        ("SoapFilm", "Pts Strength", "0c68b153-3c88-4e62-9827-f3793c013f88", "Film", "mesh"),
        ("SoapFilm", "M Strength", "76ab889c-8593-4892-861d-a80b5311a981", "Source", "mesh"),
        ("CyclicQuad", "P0 P1 P2 P3 Strength", "15ab0db0-5093-4a37-854a-cee70457a847", "Faces", "mesh"),
        ("TangentIncircles", "M B Strength", "3962cf86-9b9e-41d7-94f9-42bd0326291d", "Source", "mesh"),
    ],
)
def test_versions_of_a_goal_are_told_apart_by_their_inputs(
    name: str, names: str, guid: str, helper: str, column: str
) -> None:
    d = Kangaroo("versions", "Versions", "One goal, older or newer.")
    source = d.parameter("Data", "Source")
    wired = {one.lower(): source for one in names.split() if one not in ("B", "Strength")}
    goal = d.kangaroo(name, [(one, None) for one in names.split()], ["G"], guid=UUID(guid), **wired)
    d.solved(goal)
    after, report = translated(d)
    found = next(p for p in parts(after) if p.id == goal.id)
    assert [part.label for part in behind(after, found, column)] == [helper] and report.complete


def test_goals_in_one_stream_are_sorted_and_show_becomes_a_parameter() -> None:
    after, report = translated(tent())
    engine = the(after, "Engine")
    assert [behind(after, engine, name)[0].label for name in ("forces", "anchors", "geometry")] == ["Sort"] * 3
    assert [found.label for found in behind(after, the(after, "Sort"), "goals")] == ["Goals"]
    assert the(after, "Show").guid == PARAMETERS["Data"]
    assert len(wires(after)) > report.kept
    [settings_] = behind(after, engine, "settings")
    [solver] = behind(after, settings_, "solver")
    [merging] = behind(after, settings_, "tolerance")  # Kangaroo 2's 0.01 is not ours
    assert [p.container.value("UserText") for p in (solver, merging) if p.container] == ["momentum", "0.01"]


def test_a_goal_without_counterpart_keeps_its_whole_system_as_it_was() -> None:
    """Half a system runs in neither engine: solver and goals stay on with their wires, and a mesh tool beside them."""
    d = Kangaroo("stays", "Stays", "G2 and Refine.")
    mesh = d.parameter("Mesh", "Mesh")
    refined = d.kangaroo("Refine", (("M", None), ("L", 1)), ["M"], m=mesh)
    edges = d.kangaroo("EdgeLengths", (("Mesh", None), ("LengthFactor", 1.0), ("Strength", 1.0)), ["EL"], mesh=refined)
    d.solved(d.kangaroo("G2", (("Points", None), ("Strength", 1.0)), ["G2"], points=mesh), edges)
    after, report = translated(d)
    assert (report.solvers, report.whole, report.swapped, report.lost) == (1, 0, [], [])
    assert dict(report.stays) == {
        "Refine": "a tool for geometry; it stays with the system that it feeds",
        "G2": "curves have no elements here whose curvature could be made equal; Smooth and Bend act on polylines",
        "EdgeLengths": "it stays with Solver",
        "Solver": "it stays with all its goals, because of G2",
    }
    assert same_objects(d.archive(), after) == []
    names = [c.value("Name") for c in after.chunk("Definition").chunk("GHALibraries").chunks]  # type: ignore[union-attr]
    assert names == ["RhinoCodePluginGH", "Kangaroo2 Components"]


def same_objects(before: Chunk, after: Chunk) -> list[str]:
    """Objects that are not the same, item by item, before and after; by their labels."""
    held = {part.id: part.chunk for part in parts(after)}
    return [part.label for part in parts(before) if held.get(part.id) != part.chunk]


@pytest.mark.thinned
@pytest.mark.parametrize(
    "known", sampled(sorted({*COMPONENTS.values(), *(Known("classic", n) for n in CLASSIC)}, key=str), 4), ids=str
)
def test_every_component_of_kangaroo_is_translated_or_named(known: Known) -> None:
    guids = [guid for guid, one in COMPONENTS.items() if one == known] or [UUID(int=7)]
    for guid in guids:
        d = Kangaroo(f"one {known.name}", "One", "One component of Kangaroo.")
        names = [name for piece in swap_of(known).pieces for name in piece.inputs] if swap_of(known) else ["P"]  # type: ignore[union-attr]
        source = d.parameter("Data", "Source")
        inputs_ = [(name, None) for name in dict.fromkeys([*names, "Another"])]
        classic, what = known.generation == "classic", role(known)
        made = d.kangaroo(
            known.name, inputs_, ["Out"], guid=guid, classic=classic, **{name.lower(): source for name, _ in inputs_}
        )
        if what is Role.GOAL and known.name == "Kangaroo Settings":
            d.solved(classic=True, settings=made)
        elif what is Role.GOAL:
            d.solved(made, classic=classic)
        after, report = translated(d)
        text = report.text()
        assert known.name in text
        if report.swapped:
            assert remaining(after) == 0 and report.lost and "Another" in text and report.whole == report.solvers
        else:
            assert remaining(after) == report.kangaroo and report.kept == report.wires
            whys = dict(report.stays)
            assert ("it stays on" in whys[known.name]) == (what is Role.TOOL)
            assert what is not Role.GOAL or "because of" in " ".join(whys.values())


def test_every_input_of_the_table_is_one_of_a_component_that_there_is() -> None:
    from hookean_canvas.components import bundles
    from hookean_canvas.kangaroo.make import recipe

    others = [(name, swap.other) for name, swap in [*CLASSIC.items(), *SECOND.items()] if swap.other]
    for name, swap in [*CLASSIC.items(), *SECOND.items(), *others]:
        for piece in swap.pieces:
            if piece.bundle in FLOATING or not piece.bundle.startswith("*") and piece.bundle not in bundles.names():
                continue
            made = recipe(piece.bundle)
            ours = {slot.name.strip("_") for slot in made.inputs}
            taken = {one for both in piece.inputs.values() for one in both.split("|")}
            assert {*taken, *piece.values} <= ours, (name, piece)
            assert {*piece.outputs, *piece.feeds} <= {slot.name for slot in made.outputs}, (name, piece)


def test_the_table_of_the_docs_is_the_table_of_the_import() -> None:
    page = (Path(__file__).parents[2] / "docs" / "canvas.md").read_text(encoding="utf-8")
    assert markdown() in page, "docs/canvas.md does not hold what hookean_canvas.kangaroo.table.markdown() gives"


@pytest.mark.parametrize(("number", "held", "gone"), [(0, ["verlet"], 0), (1, ["yoshida"], 0), (3, [], 1)])
def test_a_typed_solver_becomes_a_word_or_is_told(number: int, held: list[str], gone: int) -> None:
    d = Kangaroo("solver", "Solver", "A typed solver.")
    given = [(name, number if name == "Solver" else value) for name, value in SETTINGS]
    d.solved(classic=True, settings=d.kangaroo("Kangaroo Settings", given, ["Settings"], classic=True))
    after, report = translated(d)
    found = [part.container for part in behind(after, the(after, "Settings"), "solver")]
    assert [container.value("UserText") for container in found if container] == held
    assert len(report.values) == gone


def test_clusters_and_scripts_that_use_kangaroo_are_named() -> None:
    d = Kangaroo("inside", "Inside", "Kangaroo in a cluster and in a script.")
    d.script("Scripted", "import clr\nclr.AddReference('KangarooSolver')\nx = 1", {}, ["x"])
    d.script("Plain", "x = 1  # no kangaroo", {}, ["x"])
    root = d.archive()
    inner = Kangaroo("inner", "Inner", "In a cluster.")
    inner.kangaroo("Smooth", (("M", None),), ["P"])
    objects = root.chunk("Definition").chunk("DefinitionObjects")  # type: ignore[union-attr]
    assert objects is not None
    for label, document in (("Bad", archive.to_bytes(inner.archive())), ("Shut", b"locked")):
        thing = (
            objects.add("Object", len(objects.chunks))
            .put("GUID", Type.GUID, CLUSTER)
            .put("Name", Type.STRING, "Cluster")
        )
        container = thing.add("Container").put("NickName", Type.STRING, label).put("Name", Type.STRING, "Cluster")
        container.put("InstanceGuid", Type.GUID, UUID(int=len(objects.chunks))).put(
            "ClusterDocument", Type.BYTEARRAY, document
        )
    objects.put("ObjectCount", Type.INT32, len(objects.chunks))
    _, report = kangaroo.translate(root)
    assert [what for what, _ in report.stays] == ["Scripted", "Bad", "Shut"]
    told = [why for _, why in report.stays]
    assert "uses Kangaroo's solver" in told[0] and "holds Smooth" in told[1] and "cannot be opened" in told[2]


def test_a_classic_component_that_is_a_cluster_of_others_is_translated_by_its_name() -> None:
    inner = Kangaroo("inner", "Inner", "In the cluster.")
    inner.kangaroo("Hinge", (("P1", None),), ["H"], guid=UUID(int=8), classic=True)
    d = Kangaroo("shell", "Shell", "A cluster that comes with Kangaroo.")
    given = (("Mesh", None), ("Strength", 250.0), ("AngleFactor", None))
    shell = d.kangaroo("Shell", given, ["ShellForce"], guid=CLUSTER, classic=True, mesh=d.parameter("Mesh", "Mesh"))
    shell.library = None
    d.solved(shell, classic=True)
    shell.container.put("ClusterDocument", Type.BYTEARRAY, archive.to_bytes(inner.archive()))
    after, report = translated(d)
    assert [by for _, by, _ in report.swapped] == ["Shell", "Hookean Engine"] and report.complete
    [held] = behind(after, the(after, "Shell"), "strength")
    assert held.container is not None and held.container.value("UserText") == "250"


def test_encoded_scripts_are_found_wherever_the_name_starts() -> None:
    from hookean_canvas.kangaroo.solver_scripts import _ENCODED

    for before in ("", "x", "xx", "xxx"):
        text = base64.b64encode(f"{before}KangarooSolver # more".encode()).decode()
        assert any(code in text for code in _ENCODED)


@pytest.mark.parametrize("encoded", [False, True])
def test_a_script_that_uses_kangaroo_is_reported_with_what_it_does(encoded: bool) -> None:
    """A C# script with a goal of its own, one of Kangaroo's, and a solver that it steps itself."""
    code = (
        "using KangarooSolver;\nvar PS = new KangarooSolver.PhysicalSystem();\n"
        "var a = new KangarooSolver.Goals.Anchor(p, 1.0); var s = new Goals.Spring(0, 1, 2.0, 3.0);\n"
        "public class Swirl : GoalObject { }\n"
    )
    d = Kangaroo("coded", "Coded", "A script.")
    script = d.native_like("C# Script", "a9a8ebd2-fff5-4c44-a8f5-739736d129ba", ["x"], "A")
    text = base64.b64encode(code.encode()).decode() if encoded else code
    script.container.put("ScriptSource", Type.STRING, text)
    d.solved(script)
    _, report = translated(d)
    [why] = [why for _, why in report.stays if why.startswith("a script")]
    assert why == (
        "a script that uses Kangaroo's solver: it defines goals of its own (Swirl); makes goals of Kangaroo's "
        "(Anchor, Spring); runs a solver of its own"
    )
    assert report.whole == 0


def test_members_and_wires_that_were_never_there_stay_and_are_reported() -> None:
    """Grasshopper drops them when it opens the file; what they lead to may be in a chunk that is not read here."""
    d = cable()
    before = d.archive()
    group = next(part for part in parts(before) if part.name == "Group")
    count = group.container.value("ID_Count")  # type: ignore[union-attr]
    group.container.put("ID", Type.GUID, UUID(int=3), count).put("ID_Count", Type.INT32, count + 1)  # type: ignore[union-attr]
    gone = the(before, "particles").container
    assert gone is not None
    gone.put("Source", Type.GUID, UUID(int=4), 1).put("SourceCount", Type.INT32, 2)
    after, report = kangaroo.translate(before)
    assert set(lint.faults(after)) == set(lint.faults(before)) != set()
    assert "the wire 00000000-0000-0000-0000-000000000004 > particles comes from nothing in the file" in report.notes


def test_a_length_wired_from_the_springs_own_lines_is_measured() -> None:
    d = Kangaroo("measured", "Measured", "Rest length by a line.")
    line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0))
    d.solved(d.springs(line, rest_length=line), classic=True)
    after, report = translated(d)
    [length] = behind(after, the(after, "Springs"), "rest_length")
    assert length.name == "Length" and report.kept == report.wires


def test_the_report_stands_in_the_file_and_the_same_input_gives_the_same_bytes() -> None:
    after, report = translated(tent())
    note = the(after, "Translated for hookean")
    assert note.guid == PANEL and note.container is not None
    words = " ".join(note.container.value("UserText").split())
    assert " ".join(report.text().split()) == words
    assert archive.to_xml(after) == archive.to_xml(kangaroo.translate(tent().archive(), "sample.gh")[0])


def test_a_translated_definition_translates_to_itself_with_nothing_to_do() -> None:
    after, _ = translated(cable())
    again, report = kangaroo.translate(after)
    assert report.kangaroo == 0 and report.complete and wires(again) == wires(after)


ODD: list[tuple[Type, Any]] = [
    (Type.INT32, -1),
    (Type.INT32, 2**31 - 1),
    (Type.STRING, "text"),
    (Type.GUID, UUID(int=9)),
    (Type.DOUBLE, float("nan")),
    (Type.BYTEARRAY, b"bytes"),
    (Type.BOOL, True),
    (Type.POINT3D, (1.0, 2.0, 3.0)),
    (Type.DRAWING_RECTANGLEF, (0.0, 0.0, float("inf"), float("nan"))),
]
SAMPLES: dict[Any, Chunk] = {}

GOALS: list[tuple[str, str, str]] = [
    ("Length(Line)", "Line Length Strength", "S"),
    ("Show", "G", "G"),
    ("Isothermic", "M Strength", "P"),
    ("AnchorXYZ", "P X Y Z Strength", "A"),
    ("Anchor", "P T Strength", "A"),
    ("Load", "P FV W", "U"),
    ("Rod", "Polyline LengthFactor AngleFactor AxialStrength BendStrength", "R"),
    ("Grab", "On", "G"),
    ("Angle", "LineA LineB RestAngle Strength", "A"),
    ("VertexLoads", "Mesh Strength", "L"),
    ("Solver", "GoalObjects Reset Threshold Tolerance On", "O"),
    ("ZombieSolver", "GoalObjects Threshold Tolerance MaxIterations", "O"),
    ("Refine", "M L", "M"),
]


@settings(max_examples=300 if SOAK else 15, deadline=None)
@given(st.data())
def test_no_wire_is_lost_unseen_however_things_are_wired(data: st.DataObject) -> None:
    d = Kangaroo("random", "Random", "Any components, any wires.")
    made: list[Any] = [d.parameter("Data", "Source")]
    for number in range(data.draw(st.integers(1, 8))):
        name, names, output = data.draw(st.sampled_from(GOALS))
        typed = [(n, data.draw(st.sampled_from([None, True, 2.5, 7]))) for n in names.split()]
        wired = {n.lower(): data.draw(st.lists(st.sampled_from(made), max_size=2, unique_by=id)) for n in names.split()}
        made.append(d.kangaroo(name, typed, [output], **{n: w for n, w in wired.items() if w}))
        if data.draw(st.booleans()):
            d.panel(f"panel {number}", made[-1])
    translated(d)


@settings(max_examples=1000 if SOAK else 25, deadline=None)
@given(
    st.sampled_from([cable, star, tent]),
    st.integers(0, 10**6),
    st.integers(0, 10**6),
    st.sampled_from([None, *ODD]),
)
def test_damaged_definitions_are_translated_or_refused_in_a_sentence(
    sample: Callable[[], Kangaroo], place: int, which: int, odd: tuple[Type, Any] | None
) -> None:
    root = SAMPLES.setdefault(sample, sample().archive())
    root = copied(root)
    held = list(root.walk())
    chunk = held[place % len(held)]
    parts_ = [*chunk.items, *chunk.chunks]
    if not parts_:
        return
    part = parts_[which % len(parts_)]
    if odd is None:
        chunk.items = [item for item in chunk.items if item is not part]
        chunk.chunks = [inner for inner in chunk.chunks if inner is not part]
    elif isinstance(part, Item):
        part.type, part.value = odd
    else:
        part.name, part.index = "Odd", which % 7 - 1
    try:
        kangaroo.translate(root, "damaged.gh")
    except InputError as error:
        assert str(error).count("\n") == 0


def test_the_command_writes_beside_the_file_and_says_what_it_did(tmp_path: Path) -> None:
    source = tmp_path / "tent.gh"
    tent().save(source)
    shell = CliRunner()
    found = shell.invoke(app, ["import", str(source)])
    assert found.exit_code == 0 and "6 of Kangaroo's" not in found.stdout
    assert "Wires that are gone" in found.stdout and found.stdout.endswith(
        f"written: {tmp_path / 'tent-hookean.ghx'}\n"
    )
    assert lint.faults(archive.read(tmp_path / "tent-hookean.ghx")) == []
    assert shell.invoke(app, ["import", str(source), "-o", str(tmp_path / "other.gh")]).exit_code == 0
    assert shell.invoke(app, ["check", str(tmp_path / "other.gh")]).exit_code == 0


def test_bad_files_are_refused_in_one_sentence(tmp_path: Path) -> None:
    source = tmp_path / "star.ghx"
    star().save(source)
    (tmp_path / "words.gh").write_text("no archive")
    archive.write(Chunk("Root"), tmp_path / "empty.ghx")
    shell = CliRunner()
    for words, said in [
        ([str(source), "-o", str(source)], "is the input file"),
        ([str(source), "-o", str(tmp_path / "x.txt")], "end in .gh"),
        ([str(tmp_path / "none.gh")], "cannot be read"),
        ([str(tmp_path / "words.gh")], "words.gh"),
        ([str(tmp_path / "empty.ghx")], "not a Grasshopper definition"),
    ]:
        found = shell.invoke(app, ["import", *words])
        assert found.exit_code == 2 and said in found.stderr and found.stderr.count("\n") == 1


@pytest.mark.parametrize("kind", ["panel", "toggle", "parameter"])
@pytest.mark.parametrize("value", [True, False])
def test_a_wire_with_the_usual_value_into_an_input_without_counterpart_is_no_loss(kind: str, value: bool) -> None:
    """A solid that stays where it is is what Unidirectional asks for with True; with False it is lost."""
    d = Kangaroo("way", "Way", "A wired flag.")
    if kind == "panel":
        flag = d.text("Flag", str(value))
    else:
        flag = d.toggle("Flag", value) if kind == "toggle" else d.parameter("Boolean", "Flag", [value])
    typed = (("Points", None), ("Solid", None), ("Interior", False), ("Unidirectional", True), ("Strength", 1.0))
    points, solid = d.parameter("Point", "Points"), d.parameter("Mesh", "Solid")
    d.solved(d.kangaroo("SolidPointCollide", typed, ["S"], points=points, solid=solid, unidirectional=flag))
    _, report = translated(d)
    assert report.complete == value
    assert [why for _, why in (report.idle if value else report.lost)] == ["the solid stays where it is"]
