"""Checks of Grasshopper files: nothing is found in good ones, and each fault put into one is found and named."""

from __future__ import annotations

import base64
import uuid
from collections.abc import Callable
from pathlib import Path

import pytest

from canvas.archives import PACKAGES, samples, user_objects
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Item, Type, guids
from hookean_canvas.archive.parts import Code
from hookean_canvas.inspect import lint, lint_code, lint_refused
from soak import SOAK

EVERY = 1 if SOAK else 8
"""User objects are compiled by a Python 2.7 one by one: each of them in the long run, some in the short."""

KNOWN = {"LB Versioner.ghuser": ["output 'Vviiiiiz!' is not a name that a script can use"]}
"""What really is odd in released files."""


def guid(number: int) -> uuid.UUID:
    return uuid.UUID(int=number)


def add_object(objects: Chunk, kind: uuid.UUID, name: str, id: int) -> Chunk:
    """The next object; returns its container."""
    index = len(objects.chunks)
    chunk = objects.add("Object", index).put("GUID", Type.GUID, kind).put("Name", Type.STRING, name)
    objects.put("ObjectCount", Type.INT32, index + 1)
    container = chunk.add("Container").put("InstanceGuid", Type.GUID, guid(id)).put("Name", Type.STRING, name)
    return container.put("NickName", Type.STRING, name)


def add_port(data: Chunk, side: str, name: str, id: int, *sources: int) -> Chunk:
    index = data.value(f"{side}Count", default=0)
    data.put(f"{side}Count", Type.INT32, index + 1).put(f"{side}Id", Type.GUID, guids.SCRIPT_PARAMETER, index)
    port = data.add(f"{side}Param", index).put("InstanceGuid", Type.GUID, guid(id)).put("NickName", Type.STRING, name)
    port.put("TypeHintID", Type.GUID, guids.HINTS["float"])
    for number, source in enumerate(sources):
        port.put("Source", Type.GUID, guid(source), number)
    return port.put("SourceCount", Type.INT32, len(sources))


def add_script(container: Chunk, text: str, taxon: str = "*.*.python", version: str = "3.*") -> Chunk:
    script = container.add("Script").put("Text", Type.STRING, base64.b64encode(text.encode()).decode())
    script.add("LanguageSpec").put("Taxon", Type.STRING, taxon).put("Version", Type.STRING, version)
    return script


def definition() -> Chunk:
    """A slider, a script and a panel in a row, and a group around them."""
    root = Chunk("Root").put("ArchiveVersion", Type.VERSION, (0, 2, 2))
    found = root.add("Definition").put("plugin_version", Type.VERSION, (1, 0, 8))
    found.add("DocumentHeader").put("DocumentID", Type.GUID, guid(99))
    libraries = found.add("GHALibraries").put("Count", Type.INT32, 1)
    libraries.add("Library", 0).put("Id", Type.GUID, guids.SCRIPT_LIBRARY)
    objects = found.add("DefinitionObjects")
    slider = add_object(objects, guids.NUMBER_SLIDER, "Number Slider", 1).put("SourceCount", Type.INT32, 0)
    inner = slider.add("Slider").put("Min", Type.DOUBLE, 0.0).put("Max", Type.DOUBLE, 9.0)
    inner.put("Value", Type.DOUBLE, 3.0)
    script = add_object(objects, guids.PYTHON3_SCRIPT, "Python 3 Script", 2)
    objects.chunks[1].put("Lib", Type.GUID, guids.SCRIPT_LIBRARY)
    data = script.add("ParameterData")
    converter = add_port(data, "Input", "x", 3, 1).add("ConverterData")
    converter.put("AssemblyName", Type.STRING, "System.Private.CoreLib").put("TypeName", Type.STRING, "System.Double")
    add_port(data, "Output", "a", 4)
    add_script(script, "a = x if x else (b := 2)\n")
    panel = add_object(objects, guids.PANEL, "Panel", 5).put("SourceCount", Type.INT32, 1)
    panel.put("Source", Type.GUID, guid(4), 0)
    point = add_object(objects, guids.PARAMETERS["Point"], "Point", 6).put("SourceCount", Type.INT32, 0)
    branch = point.add("PersistentData").put("Count", Type.INT32, 1).add("Branch", 0).put("Count", Type.INT32, 1)
    branch.put("Path", Type.STRING, "{0;-1}").add("Item", 0).put("Coordinate", Type.POINT3D, (1.0, 2.0, 3.0))
    group = add_object(objects, guids.GROUP, "Group", 7).put("ID_Count", Type.INT32, 2)
    group.put("ID", Type.GUID, guid(1), 0).put("ID", Type.GUID, guid(2), 1)
    return root


def at(root: Chunk, *path: str | tuple[str, int]) -> Chunk:
    for step in path:
        root = root.chunk(step) if isinstance(step, str) else root.chunk(*step)
    return root


def objects(root: Chunk) -> Chunk:
    return at(root, "Definition", "DefinitionObjects")


def container(root: Chunk, index: int) -> Chunk:
    return at(objects(root), ("Object", index), "Container")


def port(root: Chunk, side: str = "Input") -> Chunk:
    return at(container(root, 1), "ParameterData", (f"{side}Param", 0))


def script(root: Chunk) -> Chunk:
    return at(container(root, 1), "Script")


def drop(chunk: Chunk, name: str) -> None:
    chunk.items = [item for item in chunk.items if item.name != name]
    chunk.chunks = [inner for inner in chunk.chunks if inner.name != name]


def test_a_sound_definition_has_no_faults() -> None:
    root = definition()
    assert lint.faults(root) == []
    assert lint.faults(archive.of_xml(archive.to_xml(root))) == []


def encoded(text: str) -> str:
    return base64.b64encode(text.encode()).decode()


Spoil = Callable[[Chunk], object]
SPOILED: dict[str, tuple[Spoil, str]] = {
    "count of objects": (
        lambda r: objects(r).put("ObjectCount", Type.INT32, 9),
        "DefinitionObjects counts 9 in ObjectC",
    ),
    "indices of objects": (
        lambda r: setattr(objects(r).chunks[4], "index", 7),
        "numbers its Object [0, 1, 2, 3, 7], not 0",
    ),
    "two objects of one index": (lambda r: setattr(objects(r).chunks[4], "index", 3), "holds 2 chunks Object[3]"),
    "no ids of the kind": (lambda r: drop(objects(r).chunks[2], "GUID"), "object 2 (Panel): it has no GUID"),
    "no container": (lambda r: drop(objects(r).chunks[4], "Container"), "object 4 (Group): it has no Container"),
    "no own id": (lambda r: drop(container(r, 3), "InstanceGuid"), "object 3 (Point): its Container has no Instance"),
    "an id as text": (
        lambda r: container(r, 3).put("InstanceGuid", Type.STRING, "6"),
        "its Container has InstanceGuid as gh_string, not gh_guid",
    ),
    "an id twice": (
        lambda r: port(r).put("InstanceGuid", Type.GUID, guid(5)),
        "occurs 2 times: object 1 (Python 3 Script) InputParam[0], object 2 (Panel)",
    ),
    "a wire from nowhere": (
        lambda r: container(r, 2).put("Source", Type.GUID, guid(77), 0),
        "the wire into 'Panel' comes from 00000000-0000-0000-0000-00000000004d, not an output here",
    ),
    "a wire from an input": (lambda r: container(r, 2).put("Source", Type.GUID, guid(3), 0), "not an output here"),
    "count of wires": (lambda r: port(r).put("SourceCount", Type.INT32, 0), "(x) counts 0 in SourceCount, but holds 1"),
    "a circle of wires": (
        lambda r: container(r, 0).put("Source", Type.GUID, guid(4), 0).put("SourceCount", Type.INT32, 1),
        "wires run in a circle: object",
    ),
    "an unknown component": (
        lambda r: objects(r).chunks[2].put("GUID", Type.GUID, guid(123)),
        "object 2 (Panel): its id 00000000-0000-0000-0000-00000000007b is unknown",
    ),
    "a wrong name": (
        lambda r: objects(r).chunks[2].put("Name", Type.STRING, "Pannel"),
        "that of 'Panel', not of 'Pannel'",
    ),
    "an undeclared library": (
        lambda r: objects(r).chunks[1].put("Lib", Type.GUID, guid(55)),
        "its library 00000000-0000-0000-0000-000000000037 is not among GHALibraries",
    ),
    "count of libraries": (
        lambda r: at(r, "Definition", "GHALibraries").put("Count", Type.INT32, 0),
        "GHALibraries counts 0",
    ),
    "count of inputs": (
        lambda r: at(container(r, 1), "ParameterData").put("InputCount", Type.INT32, 2),
        "ParameterData counts 2 in InputCount, but holds 1",
    ),
    "no type of an input": (
        lambda r: drop(at(container(r, 1), "ParameterData"), "InputId"),
        "ParameterData counts 1 in Inp",
    ),
    "an unknown kind of input": (
        lambda r: at(container(r, 1), "ParameterData").put("InputId", Type.GUID, guid(5), 0),
        "InputId[0] is 00000000-0000-0000-0000-000000000005, which is an unknown kind of parameter",
    ),
    "an unknown hint": (lambda r: port(r).put("TypeHintID", Type.GUID, guid(5)), "input 'x' has the type hint 0000"),
    "a converter of another hint": (
        lambda r: port(r).put("TypeHintID", Type.GUID, guids.HINTS["int"]),
        "input 'x' is hinted as int, that is System.Int32, but is converted to System.Double",
    ),
    "a name no script can use": (
        lambda r: port(r).put("NickName", Type.STRING, "x y"),
        "input 'x y' is not a name that a script",
    ),
    "code that does not compile": (
        lambda r: script(r).put("Text", Type.STRING, encoded("a = (1\n")),
        "object 1 (Python 3 Script): the script does not compile as python 3: line 1",
    ),
    "code newer than Rhino 8's Python": (
        lambda r: script(r).put("Text", Type.STRING, encoded("match x:\n    case 1: pass\n")),
        "Pattern matching is only supported in Python 3.10 and greater",
    ),
    "code that is no base64": (lambda r: script(r).put("Text", Type.STRING, "a = 1"), "the script's text is no base64"),
    "code for another Python": (
        lambda r: at(script(r), "LanguageSpec").put("Version", Type.STRING, "2.*"),
        "the script is in python 2, the component runs python 3",
    ),
    "no code": (lambda r: drop(container(r, 1), "Script"), "holds no script"),
    "a slider beyond its end": (
        lambda r: at(container(r, 0), "Slider").put("Value", Type.DOUBLE, 9.5),
        "object 0 (Number Slider): the slider has the value 9.5, outside its limits 0 to 9",
    ),
    "count of a branch": (
        lambda r: at(container(r, 3), "PersistentData", ("Branch", 0)).put("Count", Type.INT32, 5),
        "object 3 (Point): a branch of the data of it counts 5",
    ),
    "a path that is none": (
        lambda r: at(container(r, 3), "PersistentData", ("Branch", 0)).put("Path", Type.STRING, "0;1"),
        "has a branch with the path '0;1', not one like '{0;1}'",
    ),
    "a member that is not there": (
        lambda r: container(r, 4).put("ID", Type.GUID, guid(66), 1),
        "object 4 (group Group): its member 00000000-0000-0000-0000-000000000042 is not in the definition",
    ),
    "count of members": (lambda r: container(r, 4).put("ID_Count", Type.INT32, 1), "the group counts 1 in ID_Count"),
    "a wire that is no id": (
        lambda r: port(r).put("Source", Type.STRING, "1", 0),
        "(x) has Source[0] as gh_string, not gh_guid",
    ),
    "a member that is no id": (
        lambda r: container(r, 4).put("ID", Type.INT32, 1, 1),
        "the group has ID[1] as gh_int32, not gh_guid",
    ),
    "items out of order": (lambda r: port(r).items.reverse(), "the items of InputParam[0] are not sorted"),
    "an item twice": (
        lambda r: port(r).items.append(Item("TypeHintID", -1, Type.INT32, 1)),
        "holds 2 items TypeHintID",
    ),
    "no version": (lambda r: drop(r, "ArchiveVersion"), "the archive has no ArchiveVersion"),
    "no header": (lambda r: drop(at(r, "Definition"), "DocumentHeader"), "the definition has no DocumentHeader"),
    "no objects": (lambda r: drop(at(r, "Definition"), "DefinitionObjects"), "the definition has no DefinitionObjects"),
    "another root": (lambda r: setattr(r, "name", "Fragment"), "the archive has the name 'Fragment', not 'Root'"),
}


REFUSED = {
    "count of objects", "indices of objects", "two objects of one index", "no ids of the kind", "no container",
    "no own id", "an id as text", "count of wires", "count of inputs", "no type of an input", "count of members",
    "no objects", "a wire that is no id", "a member that is no id",
}  # fmt: skip
"""Of these Grasshopper reads an object not at all or not whole; the others it repairs, drops or ignores."""


@pytest.mark.parametrize("fault", SPOILED)
def test_each_fault_of_a_definition_is_named_and_refused_only_where_grasshopper_does(fault: str) -> None:
    """Grasshopper's reader (GH_IO 7.23) was seen to take unsorted items, wrong root names and ids that mean nothing."""
    spoil, says = SPOILED[fault]
    root = definition()
    spoil(root)
    assert any(says in one for one in lint.faults(root)), lint.faults(root)
    refused = lint_refused.refusals(root)
    assert bool(refused) == (fault in REFUSED), refused
    assert set(refused) <= set(lint.faults(root))


def test_components_of_a_declared_library_pass() -> None:
    """Grasshopper knows a plug-in's components, the table does not: their library has to be named."""
    root = definition()
    libraries = at(root, "Definition", "GHALibraries").put("Count", Type.INT32, 2)
    libraries.add("Library", 1).put("Id", Type.GUID, guid(200))
    objects(root).chunks[2].put("GUID", Type.GUID, guid(201)).put("Lib", Type.GUID, guid(200))
    assert lint.faults(root) == []


def test_an_archive_of_another_kind_is_said() -> None:
    assert lint_refused.refusals(Chunk("Root")) == lint.faults(Chunk("Root"))
    assert lint.faults(Chunk("Root")) == ["the archive (Root) contains no definition and no user object"]


# ------------------------------------------------------------------------------------------------------ real files


def test_what_grasshopper_saves_is_not_refused() -> None:
    """Components of plug-ins, members of groups that were deleted, wires from what is gone, items of older versions."""
    root = definition()
    for number, odd in ((2, "Weaverbird"), (3, "Pt")):
        objects(root).chunks[number].put("GUID", Type.GUID, guid(300 + number)).put("Name", Type.STRING, odd)
    container(root, 4).put("ID", Type.GUID, guid(66), 1)
    container(root, 2).put("Source", Type.GUID, guid(77), 0)
    port(root).items.reverse()
    at(container(root, 0), "Slider").put("Value", Type.DOUBLE, 9.5)
    script(root).put("Text", Type.STRING, encoded("a = (1\n"))
    assert len(lint.faults(root)) >= 7 and lint_refused.refusals(root) == []


def test_shared_files_have_no_faults() -> None:
    assert {file.name: lint.faults(archive.read(file)) for file in samples()} == {file.name: [] for file in samples()}


@pytest.mark.parametrize("package", PACKAGES)
def test_nothing_is_refused_of_installed_user_objects(package: str) -> None:
    """All of them were saved by Grasshopper or its library, also those with odd names."""
    files = user_objects(package)
    assert files and [file.name for file in files if lint_refused.refusals(archive.read(file))] == []


@pytest.mark.parametrize("package", PACKAGES)
def test_installed_user_objects_have_no_faults(package: str) -> None:
    if lint_code.python2() is None:
        pytest.skip("these scripts are in Python 2, of which no interpreter is here")
    files = user_objects(package)[::EVERY]
    assert files
    for file in files:
        assert lint.faults(archive.read(file)) == KNOWN.get(file.name, []), file.name


# ---------------------------------------------------------------------------------------------------- user objects

PNG = b"\x89PNG\r\n\x1a\n" + b"\0\0\0\rIHDR" + (24).to_bytes(4) * 2


def user_object(inner: Chunk | None = None, **changed: object) -> Chunk:
    """A GhPython user object with one input and one output."""
    if inner is None:
        inner = Chunk("UserObject").put("CodeInput", Type.STRING, "print 2\r\na = x")
        data = inner.add("ParameterData")
        add_port(data, "Input", "x", 1).put("TypeHintID", Type.GUID, guids.HINTS_IRONPYTHON["float"])
        add_port(data, "Output", "a", 2)
    values = {"BaseID": guids.GHPYTHON_SCRIPT, "Exposure": 2, "Icon": PNG, "InstanceGuid": guid(9)}
    values |= {"Object": archive.to_bytes(inner)} | changed
    root = Chunk("UserObject")
    for name in ("Category", "Description", "Name", "NickName", "SubCategory"):
        root.put(name, Type.STRING, name)
    for name, value in values.items():
        root.put(name, lint._OUTER[name], value)
    return root


def test_a_sound_user_object_has_no_faults() -> None:
    if lint_code.python2() is None:
        pytest.skip("its script is in Python 2, of which no interpreter is here")
    assert lint.faults(user_object()) == []
    assert lint.faults(user_object(Exposure=lint.OBSCURE + 4)) == []


def inner_with(text: str) -> Chunk:
    return Chunk("UserObject").put("CodeInput", Type.STRING, text)


def twins() -> Chunk:
    inner = inner_with("a = 1")
    data = inner.add("ParameterData")
    add_port(data, "Input", "x", 1)
    add_port(data, "Input", "x", 1)
    return inner


@pytest.mark.parametrize(
    ("root", "says"),
    [
        (user_object(BaseID=guid(4)), "its base 00000000-0000-0000-0000-000000000004 is unknown"),
        (user_object(Exposure=3), "its exposure is 3"),
        (user_object(Icon=b"GIF89a"), "its icon is not a PNG"),
        (user_object(Icon=PNG[:-1] + b"\x40"), "its icon has 24 x 64 pixels, not 24 x 24"),
        (user_object(Object=b"xx"), "the object in it: "),
        (user_object(inner_with("a = (")), "the script does not compile as python 2: line 1"),
        (user_object(Chunk("UserObject")), "holds no script"),
        (user_object(twins()), "the id 00000000-0000-0000-0000-000000000001 occurs 2 times"),
        (user_object(twins()), "input 'x' occurs twice"),
    ],
)
def test_each_fault_of_a_user_object_is_named(root: Chunk, says: str) -> None:
    assert any(says in fault for fault in lint.faults(root)), lint.faults(root)


# ------------------------------------------------------------------------------------------------------------ code


def test_python_2_is_compiled_by_python_2_or_read_as_what_both_have(monkeypatch: pytest.MonkeyPatch) -> None:
    both, old, new = "print('ü')\n", "print 1\n", "f'{1}'\n"
    if lint_code.python2() is not None:
        assert [bool(lint_code.code_faults(Code(text, "python 2"))) for text in (both, old, new)] == [
            False,
            False,
            True,
        ]
    monkeypatch.setattr(lint_code, "python2", lambda: None)
    assert [bool(lint_code.code_faults(Code(text, "python 2"))) for text in (both, old, new)] == [False, True, False]
    assert lint_code.code_faults(Code("a = 1\0", "python 3")) != []


def test_a_shim_that_only_looks_like_python_2_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """pyenv puts a `python2.7` on the path that answers with an error where no 2.7 is chosen."""
    shim = tmp_path / "python2.7"
    shim.write_text("#!/bin/sh\necho 'command not found' >&2\nexit 127\n")
    shim.chmod(0o755)
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "none"))
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    assert lint_code.python2.__wrapped__() is None


# ------------------------------------------------------------------------------------------------------------- ids


def test_the_table_of_ids_is_sound() -> None:
    """Every id once, names without blanks around them, both flavours of hints apart where they differ."""
    lines = [
        line
        for text in (guids._SPECIAL, guids._PARAMETERS, guids.native_guids.ALL)
        for line in text.split("\n")
        if line
    ]
    assert len({line.split(" ")[0] for line in lines}) == len(lines) >= 300
    assert all(name == name.strip() != "" for names in guids.NAMES.values() for name in names)
    assert all(guids.name(guid) is not None for guid in guids.RENAMED)
    assert {name for name in guids.HINTS_IRONPYTHON if guids.HINTS[name] != guids.HINTS_IRONPYTHON[name]} == {
        "none",
        "ghdoc",
        "float",
        "str",
    }
    assert guids.hint(guids.HINTS_IRONPYTHON["float"]) == "float" == guids.hint(guids.HINTS["float"])
    assert guids.hint(guid(1)) is None and guids.name(guid(1)) is None
    assert set(guids.CONVERTERS) <= set(guids.HINTS)
