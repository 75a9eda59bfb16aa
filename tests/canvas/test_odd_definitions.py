"""Damaged and odd definitions: every command ends with a result or with one sentence, never with a traceback."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from click.testing import Result
from typer.testing import CliRunner

from canvas.archives import SHARED
from canvas.kangaroo_samples import cable, star, tent
from canvas.test_lint import add_object, at, container, definition, guid, objects
from canvas.test_show import drawn
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Item, Type, guids
from hookean_canvas.command import app
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.write import Definition
from hookean_canvas.inspect import lint
from hookean_canvas.kangaroo.streams import copied
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from serving import SOAK
from soak import sampled

HERE = Path(__file__).parents[2] / "gh_examples"
PNG = b"\x89PNG\r\n\x1a\n"
COMMANDS = ("show", "check", "draw", "run", "import")


def told(command: str, file: Path) -> Result:
    """What a command comes to; it has to end by itself, with a result or an error on the standard error."""
    target = {"draw": ["-o", str(file.with_suffix(".png"))], "import": ["-o", str(file.with_suffix(".out.gh"))]}
    words = [command, str(file), *target.get(command, []), *(["--seconds", "1"] if command == "run" else [])]
    found = CliRunner().invoke(app, words)
    assert found.exception is None or isinstance(found.exception, SystemExit), found.exception
    assert found.exit_code in (0, 1, 2), found.output
    more = found.stderr.splitlines()[1:]  # a line for each object that cannot be run
    assert found.exit_code != 2 or all(line.startswith("  ") for line in more), found.stderr
    return found


def saved(root: Chunk, folder: Path) -> Path:
    archive.write(root, folder / "odd.gh")
    return folder / "odd.gh"


def place(root: Chunk, number: int, box: tuple[float, float, float, float]) -> None:
    containers.place(container(root, number), box)


def placed() -> Chunk:
    """The definition of test_lint, each object with a place."""
    root = definition()
    for number in range(4):
        place(root, number, (100.0 * number, 20.0, 80.0, 40.0))
    return root


# ---------------------------------------------------------------------------------------------------------------- odd


def one_input_and_no_output(root: Chunk) -> None:
    preview = add_object(objects(root), UUID("059b72b0-9bb3-4542-a805-2dcd27493164"), "Custom Preview", 30)
    preview.add("param_input", 0).put("InstanceGuid", Type.GUID, guid(31)).put("Source", Type.GUID, guid(1), 0)
    containers.place(preview, (400.0, 20.0, 50.0, 30.0))


def one_output_and_no_input(root: Chunk) -> None:
    plane = add_object(objects(root), UUID("17b7152b-d30d-4d50-b9ef-c9fe25576fc2"), "XY Plane", 32)
    plane.add("param_output", 0).put("InstanceGuid", Type.GUID, guid(33))
    containers.place(plane, (400.0, 20.0, 50.0, 30.0))


def group(root: Chunk, id: int, *members: int) -> None:
    chunk = add_object(objects(root), guids.GROUP, "Group", id).put("ID_Count", Type.INT32, len(members))
    for number, member in enumerate(members):
        chunk.put("ID", Type.GUID, guid(member), number)


def groups_of_groups(root: Chunk) -> None:
    group(root, 40, 41, 1)
    group(root, 41, 40, 42)
    group(root, 42, 2, 5)


def words(root: Chunk) -> None:
    container(root, 2).put("NickName", Type.STRING, "cost $\\frac{1}$ $x_{$").put("SourceCount", Type.INT32, 0)
    container(root, 2).put("UserText", Type.STRING, "100 $ \\alpha_ $^\n\t\x00線 🏗\n" * 400)
    container(root, 2).items = [item for item in container(root, 2).items if item.name != "Source"]


BRANCH = ("PersistentData", ("Branch", 0))
ODD: dict[str, Callable[[Chunk], object]] = {
    "one input and no output": one_input_and_no_output,
    "one output and no input": one_output_and_no_input,
    "an empty group": lambda r: group(r, 40),
    "a group of what is not there": lambda r: group(r, 40, 900, 901),
    "a group of objects without a place": lambda r: group(r, 40, 7),
    "groups of groups, in a circle": groups_of_groups,
    "bounds of no size": lambda r: place(r, 1, (10.0, 10.0, 0.0, 0.0)),
    "bounds turned inside out": lambda r: place(r, 1, (10.0, 10.0, -50.0, -20.0)),
    "bounds that are not finite": lambda r: place(r, 1, (float("nan"), 0.0, float("inf"), 1.0)),
    "bounds beyond any canvas": lambda r: place(r, 1, (1e38, -1e38, 1e38, 1e38)),
    "a canvas larger than a picture": lambda r: place(r, 1, (9e5, -9e5, 80.0, 40.0)),
    "a mapping there is not": lambda r: container(r, 3).put("Mapping", Type.INT32, 9),
    "an access there is not": lambda r: container(r, 3).put("Access", Type.INT32, -4),
    "a path that is none": lambda r: at(container(r, 3), "PersistentData", ("Branch", 0)).put(
        "Path", Type.STRING, "{}"
    ),
    "words that look like formulas": words,
    "a script without inputs and outputs": lambda r: setattr(container(r, 1), "chunks", container(r, 1).chunks[1:]),
    "an unknown kind of parameter": lambda r: objects(r).chunks[3].put("GUID", Type.GUID, guid(12345)),
}


@pytest.mark.parametrize("odd", sampled(ODD, 3))
def test_odd_definitions_are_drawn_and_every_other_command_ends(odd: str, tmp_path: Path) -> None:
    root = placed()
    ODD[odd](root)
    file = saved(root, tmp_path)
    for command in COMMANDS:
        found = told(command, file)
        if command in ("show", "draw"):
            assert found.exit_code == 0, found.stderr
    assert file.with_suffix(".png").read_bytes().startswith(PNG)


def test_a_definition_without_places_and_a_picture_that_cannot_be_written_are_one_sentence(tmp_path: Path) -> None:
    file = saved(definition(), tmp_path)
    assert "none of its objects has a place on the canvas" in told("draw", file).stderr
    archive.write(placed(), file)
    for target, words in [("a.txt", "give a name that ends in .png"), ("none/a.png", "cannot be written")]:
        found = CliRunner().invoke(app, ["draw", str(file), "-o", str(tmp_path / target)])
        assert (found.exit_code, found.stderr.count("\n")) == (2, 1) and words in found.stderr


def test_a_parameter_that_was_taken_out_of_a_component_has_the_name_of_its_input() -> None:
    root = definition()
    add_object(objects(root), guids.PARAMETERS["Integer"], "Width count", 900)
    assert not [fault for fault in lint.faults(root) if "Width count" in fault and "is that of" in fault]


def test_objects_without_a_place_are_named(tmp_path: Path) -> None:
    root = placed()
    place(root, 1, (float("nan"), 0.0, float("inf"), 1.0))
    found = told("draw", saved(root, tmp_path))
    target = tmp_path / "odd.png"
    assert (found.exit_code, found.stderr) == (
        0,
        f"{target}: drawn without Python 3 Script; the file gives them no place on the canvas\n",
    )
    assert told("draw", saved(placed(), tmp_path)).stderr == ""


def test_a_group_is_drawn_around_the_groups_in_it() -> None:
    """As Grasshopper draws nested groups; here two that hold each other besides."""
    from hookean_canvas.inspect.drawing import _members

    root = placed()
    groups_of_groups(root)
    held = {found.id: found for found in graph.of(root).groups}
    assert set(_members(held[guid(40)], held)) == {guid(1), guid(2), guid(5)}
    assert set(_members(held[guid(42)], held)) == {guid(2), guid(5)}


def test_a_run_names_what_is_damaged_or_twice(tmp_path: Path) -> None:
    root = plain().archive()
    archive.write(root, tmp_path / "sound.gh")
    assert told("run", tmp_path / "sound.gh").stdout == "sum: 45\n"
    twin = copied(objects(root).chunks[1])
    twin.index = len(objects(root).chunks)
    objects(root).chunks.append(twin)
    assert "have one InstanceGuid" in told("run", saved(root, tmp_path)).stderr
    root = plain().archive()
    named = next(chunk for chunk in objects(root).chunks if chunk.value("Name") == "Series")
    held = at(named, "Container")
    held.chunks = [chunk for chunk in held.chunks if (chunk.name, chunk.index) != ("param_input", 1)]
    assert (
        "1 x Series: it has 2 inputs and 1 outputs, not 3 inputs and 1 outputs"
        in told("run", saved(root, tmp_path)).stderr
    )


# ------------------------------------------------------------------------------------------------------------- random


def plain() -> Definition:
    """A definition that runs without a service: the sum of 0 to 9."""
    d = Definition("plain", "Plain", "Numbers.")
    with d.group("Numbers"):
        numbers = d.native(
            "Series", start=0, step=d.choice("Step", {"one": "1", "two": "2"}, "one"), count=d.slider("n", 10, 0, 20)
        )
        switch, point = d.toggle("On", True), d.point(1, 2, 3)
        moved = d.native("Move", geometry=point, motion=d.parameter("Vector", "up", [(0.0, 0.0, 1.0)]))
        code = "total = sum(values) if on else len(str(places)) + float(text)"
        given = {"values": numbers, "on": switch, "places": moved["Geometry"], "text": d.text("Text", "7")}
        made = d.script("Sum", code, given, ["total"], lists=["values"])
    d.panel("sum", made)
    return d


VALUES: list[tuple[Type, Any]] = [
    (Type.INT32, -1), (Type.INT32, 0), (Type.INT32, 7), (Type.INT32, 2**31 - 1), (Type.STRING, ""),
    (Type.STRING, "text $_{"), (Type.GUID, guid(1)), (Type.GUID, guid(0)), (Type.DOUBLE, float("nan")),
    (Type.DOUBLE, -1e308), (Type.BYTEARRAY, b"bytes"), (Type.BOOL, True), (Type.POINT3D, (1.0, float("inf"), 3.0)),
    (Type.DRAWING_RECTANGLEF, (0.0, 0.0, float("inf"), float("nan"))), (Type.DRAWING_RECTANGLEF, (1e9, 0.0, 1.0, 1.0)),
    (Type.DRAWING_COLOR, (0, 0, 0, 0)), (Type.DOUBLEARRAY, ()), (Type.DATE, -1),
]  # fmt: skip


def altered(root: Chunk, chance: random.Random) -> Chunk:
    """A copy with a few items and chunks removed, doubled, moved, renamed, or given values of any type."""
    root = copied(root)
    for _ in range(chance.randint(1, 4)):
        held = list(root.walk())
        chunk = chance.choice(held)
        match chance.randrange(7):
            case 0 if chunk.items:
                del chunk.items[chance.randrange(len(chunk.items))]
            case 1 if chunk.chunks:
                del chunk.chunks[chance.randrange(len(chunk.chunks))]
            case 2 if chunk.items:
                item = chance.choice(chunk.items)
                item.type, item.value = chance.choice(VALUES)
            case 3 if chunk.items:
                item = chance.choice(chunk.items)
                chunk.items.append(Item(item.name, item.index + 1 + chance.randrange(3), *chance.choice(VALUES)))
            case 4 if chunk.chunks:
                inner = copied(chance.choice(chunk.chunks))
                inner.index += chance.randrange(3)
                chunk.chunks.insert(chance.randrange(len(chunk.chunks) + 1), inner)
            case 5 if chunk.chunks:
                chance.choice(chunk.chunks).name = chance.choice(["Odd", "Container", "param_input", "OutputParam"])
            case _:
                chunk.chunks.append(copied(chance.choice([one for one in held if len(one.chunks) < 5])))
    for chunk in root.walk():
        chunk.items = list({(item.name, item.index): item for item in chunk.items}.values())
    return root


SAMPLES: dict[str, Callable[[], Chunk]] = {
    "plain": lambda: plain().archive(),
    "drawn": drawn,
    "cable": lambda: cable().archive(),
    "star": lambda: star().archive(),
    "tent": lambda: tent().archive(),
}


@pytest.mark.slow
@pytest.mark.parametrize("sample", SAMPLES)
def test_altered_definitions_end_every_command_with_a_result_or_a_sentence(sample: str, tmp_path: Path) -> None:
    root, chance = SAMPLES[sample](), random.Random(sample)
    for _ in range(400 if SOAK else 3):
        try:
            file = saved(altered(root, chance), tmp_path)
        except InputError:
            continue  # what no archive can hold
        for command in COMMANDS:
            told(command, file)


REAL = [*sorted(HERE.glob("*/definition.gh")), *sorted(SHARED.glob("*.gh"))]


@pytest.mark.soak
@pytest.mark.parametrize("file", REAL if SOAK else REAL[::24], ids=lambda file: file.parent.name)
def test_altered_real_definitions_end_every_command_but_run(file: Path, tmp_path: Path) -> None:
    """What a run does before it solves is done; components that would start a service are not run."""
    root, chance = archive.read(file), random.Random(file.parent.name)
    for number in range(40 if SOAK else 2):
        try:
            odd = saved(altered(root, chance), tmp_path)
        except InputError:
            continue
        for command in ("show", "check", "import", *(("draw",) if number % 8 == 0 else ())):
            told(command, odd)
        try:
            Canvas(graph.read(odd))
        except InputError as error:
            assert "\n" not in str(error)
