"""`hookean canvas show` and `check`: what a person reads, what a program reads, what the exit code says."""

from __future__ import annotations

import io
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from typer.testing import CliRunner

from canvas.archives import PACKAGES, samples, user_objects
from canvas.kangaroo_samples import CLASSIC, LENGTH, PHYSICS, PHYSICS_OUT, SOLVER, Kangaroo
from canvas.test_lint import add_object, add_port, at, container, definition, guid, objects, port, user_object
from hookean.cli import app
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type, guids
from hookean_canvas.archive.chunk import DEEPEST
from hookean_canvas.inspect import lint, lint_code
from hookean_canvas.inspect.describe import describe
from hookean_canvas.inspect.show import lines, text
from soak import SOAK


def drawn() -> Chunk:
    """A definition with some of everything that is shown."""
    root = definition()
    at(root, "Definition").add("DefinitionProperties").put("Name", Type.STRING, "arch.gh").put(
        "Description", Type.STRING, "An arch"
    )
    at(root, "Definition", "GHALibraries", ("Library", 0)).put("Name", Type.STRING, "RhinoCodePluginGH").put(
        "Version", Type.STRING, "8.13"
    ).put("Author", Type.STRING, "McNeel")
    container(root, 1).put("NickName", Type.STRING, "Double")
    port(root).put("Access", Type.INT32, 1).put("Mapping", Type.INT32, 2).put("ReverseData", Type.BOOL, True)
    container(root, 4).put("NickName", Type.STRING, "all of it")
    toggle = add_object(objects(root), guids.BOOLEAN_TOGGLE, "Boolean Toggle", 20).put("SourceCount", Type.INT32, 0)
    toggle.put("ToggleValue", Type.BOOL, True)
    choice = add_object(objects(root), guids.VALUE_LIST, "Value List", 21).put("SourceCount", Type.INT32, 0)
    choice.put("ListCount", Type.INT32, 1).add("ListItem", 0).put("Name", Type.STRING, "cable").put(
        "Expression", Type.STRING, "1"
    ).put("Selected", Type.BOOL, True)
    note = add_object(objects(root), guids.PANEL, "Panel", 22).put("SourceCount", Type.INT32, 0)
    note.put("UserText", Type.STRING, "two\nlines")
    foreign = add_object(objects(root), guid(500), "Weaverbird", 23).put("Levels", Type.INT32, 2)
    data = foreign.add("ParameterData")
    add_port(data, "Input", "m", 24, 4, 999)
    stored = port_of(foreign).add("PersistentData").put("Count", Type.INT32, 1)
    stored.add("Branch", 0).put("Path", Type.STRING, "{0}")
    return root


def port_of(component: Chunk) -> Chunk:
    return at(component, "ParameterData", ("InputParam", 0))


EXPECTED = """\
arch.ghx: a definition with 8 objects, 4 wires, 1 group, Grasshopper 1.0.8
  An arch
  needs RhinoCodePluginGH 8.13 (McNeel)
  Number Slider
    3, from 0 to 9
  Python 3 Script 'Double'
    in  x (list, float, graft, reverse)
      <- Number Slider
    out a (float)
    script in python 3, 1 line
  Panel #2
    <- Double.a
  Point
    = {0;-1}: (1, 2, 3)
  Boolean Toggle
    value: true
  Value List
    chosen: (cable)
    list: cable 1
  Panel #7
    two
    lines
  Weaverbird (unknown component 00000000-0000-0000-0000-0000000001f4)
    Levels: 2
    in  m (float)
      <- Double.a
      <- 00000000-0000-0000-0000-0000000003e7, which is not in the file
  group 'all of it': Number Slider, Double
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    archive.write(drawn(), tmp_path / "arch.ghx")
    return tmp_path / "arch.ghx"


def run(*words: object) -> Any:
    return CliRunner().invoke(app, ["canvas", *map(str, words)])


def test_a_definition_is_shown_with_its_wires_by_name(file: Path) -> None:
    """In a pipe, as here, the tree is indented text."""
    result = run("show", file)
    assert (result.exit_code, result.output) == (0, EXPECTED)


def test_on_a_terminal_it_is_a_tree(file: Path) -> None:
    from hookean_canvas.inspect.show import show

    console = Console(file=io.StringIO(), force_terminal=True, width=200, highlight=False, color_system=None)
    show(file, with_code=False, as_json=False, everything=False, console=console)
    drawn_tree = console.file.getvalue()  # type: ignore[attr-defined]
    assert "├── Python 3 Script 'Double'" in drawn_tree
    assert "│   │   └── <- Number Slider" in drawn_tree


def test_code_is_shown_when_asked_for(file: Path) -> None:
    assert "      a = x if x else (b := 2)\n" in run("show", "--code", file).output


def test_programs_read_json(file: Path) -> None:
    found = json.loads(run("show", "--json", file).output)
    script = found["objects"][1]
    assert found["kind"] == "definition" and [part["index"] for part in found["objects"]] == [0, 1, 2, 3, 5, 6, 7, 8]
    assert (script["known"], script["nickname"], script["language"]) == ("Python 3 Script", "Double", "python 3")
    assert script["inputs"][0]["sources"] == [{"id": str(guid(1)), "object": "Number Slider", "output": None}]
    assert found["objects"][0]["values"] == {"value": 3.0, "from": 0.0, "to": 9.0, "decimals": None}
    assert found["objects"][3]["data"] == {"{0;-1}": [[1.0, 2.0, 3.0]]}
    assert found["groups"] == [{"name": "all of it", "members": ["Number Slider", "Double"]}]


def test_json_holds_what_json_can(tmp_path: Path) -> None:
    """Numbers without end, bytes, ids and decimals as text: strict JSON, whatever the file holds."""
    root = Chunk("Root").put("a", Type.DOUBLE, math.nan).put("b", Type.BYTEARRAY, b"123").put("c", Type.GUID, guid(1))
    root.add("Inner", 2).put("d", Type.POINT2D, (math.inf, 1.0))
    archive.write(root, tmp_path / "a.gh")
    found = json.loads(run("show", "--json", tmp_path / "a.gh").output, parse_constant=pytest.fail)
    assert found["root"]["items"] == {"a": "nan", "b": "3 bytes", "c": str(guid(1))}
    assert found["root"]["chunks"][0] == {"name": "Inner[2]", "items": {"d": ["inf", 1.0]}, "chunks": []}
    assert run("show", tmp_path / "a.gh").output.startswith("a.gh: an archive\n  Root\n    a: nan\n    b: 3 bytes\n")


def test_everything_is_shown_when_asked_for(file: Path) -> None:
    shown = run("show", "--all", file).output
    assert "\n    ArchiveVersion: (0, 2, 2)\n" in shown
    assert shown.count("InstanceGuid: ") == 12


def test_a_user_object_is_shown_with_what_is_packed_in_it(tmp_path: Path) -> None:
    archive.write(user_object(), tmp_path / "a.ghuser")
    shown = run("show", "--code", tmp_path / "a.ghuser").output
    assert shown.startswith(
        "a.ghuser: the user object 'Name' (NickName)\n  tab Category, panel SubCategory, icon 24 bytes\n"
    )
    object = ["GhPython Script", "  in  x (float)", "  out a (float)", "  script in python 2, 2 lines"]
    assert shown.splitlines()[-6:] == ["  " + line for line in [*object, "    print 2", "    a = x"]]
    archive.write(user_object(Object=b"xx"), tmp_path / "b.ghuser")
    assert "\n  the object in it: is incomplete" in run("show", tmp_path / "b.ghuser").output


def test_a_cluster_is_shown_with_the_definition_in_it() -> None:
    root = definition()
    add_object(objects(root), guids.CLUSTER, "Cluster", 30).put(
        "ClusterDocument", Type.BYTEARRAY, archive.to_bytes(definition())
    )
    shown = text(lines(describe(root), "a.gh"))
    assert "    ClusterDocument: a definition with 4 objects, 2 wires, 1 group, Grasshopper 1.0.8\n" in shown


@pytest.mark.parametrize("package", PACKAGES)
def test_installed_user_objects_are_shown_with_all_inputs_known(package: str) -> None:
    for file in user_objects(package):
        found = describe(archive.read(file))
        assert found["known"] in ("GhPython Script", "Value List"), file.name
        assert "unknown" not in json.dumps(found["object"].get("language", "")), file.name
        assert text(lines(found, file.name, with_code=True)).startswith(f"{file.name}: the user object ")


def test_shared_files_are_shown_with_no_wire_from_nowhere() -> None:
    for file in samples():
        shown = text(lines(describe(archive.read(file)), file.name))
        assert "not in the file" not in shown and "unknown" not in shown, shown


@pytest.mark.parametrize(
    "damage", ["DefinitionObjects", "Container", "ParameterData", "LanguageSpec", "Text", "GUID", "Name"]
)
def test_a_damaged_definition_is_still_shown(damage: str) -> None:
    """What is missing is left out or named; nothing else is lost."""
    root = drawn()
    for chunk in root.walk():
        chunk.items = [item for item in chunk.items if item.name != damage]
        chunk.chunks = [inner for inner in chunk.chunks if inner.name != damage]
    shown = text(lines(describe(root), "a.gh", with_code=True))
    assert "An arch" in shown and "8.13 (McNeel)" in shown


def test_check_is_quiet_where_grasshopper_would_be_and_strict_says_the_rest(file: Path, tmp_path: Path) -> None:
    archive.write(definition(), tmp_path / "good.ghx")
    for words in ((), ("--strict",)):
        good = run("check", *words, tmp_path / "good.ghx")
        assert (good.exit_code, good.output) == (0, f"{tmp_path / 'good.ghx'}: no faults\n")
    quiet = run("check", tmp_path / "good.ghx", file)
    assert (quiet.exit_code, quiet.output) == (0, f"{tmp_path / 'good.ghx'}: no faults\n{file}: no faults\n")
    bad = run("check", "--strict", tmp_path / "good.ghx", file)
    assert bad.exit_code == 1
    told = bad.output.splitlines()
    assert told[0].endswith("good.ghx: no faults")
    assert all(line.startswith(f"{file}: ") for line in told[1:])
    assert any("not an output here" in line for line in told) and any("is unknown" in line for line in told)


def test_check_prints_a_line_for_each_refusal_and_exits_with_1(tmp_path: Path) -> None:
    root = definition()
    objects(root).put("ObjectCount", Type.INT32, 9)
    container(root, 2).put("SourceCount", Type.INT32, 3)
    archive.write(root, tmp_path / "bad.gh")
    bad = run("check", tmp_path / "bad.gh")
    assert (bad.exit_code, bad.output.splitlines()) == (
        1,
        [
            f"{tmp_path / 'bad.gh'}: DefinitionObjects counts 9 in ObjectCount, but holds 5",
            f"{tmp_path / 'bad.gh'}: object 2 (Panel): it counts 3 in SourceCount, but holds 1",
        ],
    )


def test_check_goes_on_after_a_file_it_cannot_read(tmp_path: Path) -> None:
    archive.write(definition(), tmp_path / "good.ghx")
    result = run("check", tmp_path / "none.gh", tmp_path / "good.ghx")
    assert (result.exit_code, result.stdout) == (2, f"{tmp_path / 'good.ghx'}: no faults\n")
    assert result.stderr == f"hookean: {tmp_path / 'none.gh'}: cannot be read: No such file or directory.\n"


@pytest.mark.parametrize("command", ["show", "check"])
def test_what_is_no_archive_is_one_line_and_exit_code_2(command: str, tmp_path: Path) -> None:
    (tmp_path / "a.gh").write_text("no archive")
    result = run(command, tmp_path / "a.gh")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("hookean: ") and "is not a Grasshopper archive" in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("command", ["show", "check", "run", "draw", "import"])
def test_a_git_lfs_pointer_is_named_by_every_command(command: str, tmp_path: Path) -> None:
    """A pointer as git-lfs writes it (docs/spec.md of git-lfs): what a clone without Git LFS has in a file's place."""
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:" + 32 * "4d" + "\nsize 12345\n"
    (tmp_path / "form.gh").write_text(pointer)
    result = run(command, tmp_path / "form.gh", *(["-o", tmp_path / "form.png"] if command == "draw" else []))
    assert (result.exit_code, result.stdout) == (2, "")
    assert "form.gh: is a Git LFS pointer, not the file itself" in result.stderr and result.stderr.count("\n") == 1


SWAPS = [
    (Type.STRING, "text"),
    (Type.INT32, 7),
    (Type.BYTEARRAY, b"\xff"),
    (Type.GUID, guid(1)),
    (Type.PLANE, (math.nan,) * 9),
]


@pytest.mark.parametrize("sound", [drawn, user_object], ids=["definition", "user object"])
def test_items_of_another_type_break_neither_show_nor_check(
    sound: Callable[[], Chunk], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each item in turn has a type it should not have: one other in the short run, all others in the long."""
    monkeypatch.setattr(lint_code, "python2", lambda: None)
    for number in range(sum(len(chunk.items) for chunk in sound().walk())):
        for swap in SWAPS if SOAK else [SWAPS[number % len(SWAPS)]]:
            root = sound()
            item = [item for chunk in root.walk() for item in chunk.items][number]
            item.type, item.value = swap
            json.dumps(describe(root), allow_nan=False)
            text(lines(describe(root), "a.gh", with_code=True))
            lint.faults(root)


def test_components_of_kangaroo_and_of_plug_ins_are_named(tmp_path: Path) -> None:
    """By the table of ids, also under another name and without a library; else by the library that the file lists."""
    d = Kangaroo("named", "Named", "Solvers of both generations.")
    d.kangaroo("Solver", SOLVER, ["O"]).library = None
    d.kangaroo("Length(Line)", LENGTH, ["S"])
    d.kangaroo(CLASSIC, PHYSICS, PHYSICS_OUT, classic=True)
    d.kangaroo("A goal of tomorrow", (("P", None),), ["G"], guid=guid(7))
    d.foreign("Bar")
    root = d.archive()
    next(chunk for chunk in objects(root).chunks if chunk.value("Name") == "Length(Line)").put(
        "Name", Type.STRING, "Springs"
    )
    archive.write(root, tmp_path / "named.gh")
    shown = run("show", tmp_path / "named.gh").output
    heads = [line[2:] for line in shown.splitlines() if re.match(r"  \S", line)]
    assert "Solver (Kangaroo 2)" in heads and "KangarooPhysics (Kangaroo 0.099)" in heads
    assert "Springs 'Length(Line)' (Length(Line) of Kangaroo 2)" in heads
    assert "A goal of tomorrow (Kangaroo 2)" in heads and "Bar (Engineering)" in heads
    assert "unknown component" not in shown
    found = json.loads(run("show", "--json", tmp_path / "named.gh").output)["objects"]
    assert [(one["known"], one["plugin"]) for one in found if one["name"] in ("Solver", "Bar", "Panel")] == [
        ("Panel", None),
        ("Solver", "Kangaroo 2"),
        (None, "Engineering"),
    ]


def test_what_is_nested_as_deep_as_an_archive_may_be_is_shown(tmp_path: Path) -> None:
    chunk = Chunk("0")
    for level in range(1, DEEPEST):
        chunk = Chunk(str(level), chunks=[chunk])
    archive.write(chunk, tmp_path / "deep.gh")
    for words in ((), ("--all",), ("--all", "--json")):
        shown = run("show", *words, tmp_path / "deep.gh")
        assert shown.exit_code == 0 and shown.exception is None, shown.exception


@pytest.mark.soak
def test_clusters_within_clusters_end_somewhere(tmp_path: Path) -> None:
    inner = archive.to_bytes(definition())
    for _ in range(150):
        d = Kangaroo("outer", "Outer", "A cluster.")
        d.cluster("Inner", inner)
        inner = archive.to_bytes(d.archive())
    (tmp_path / "deep.gh").write_bytes(inner)
    for command in ("show", "check", "import"):
        found = run(command, tmp_path / "deep.gh")
        assert found.exit_code == 0 and found.exception is None, found.exception
