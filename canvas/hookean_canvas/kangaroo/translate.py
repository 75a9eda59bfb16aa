"""Definitions made for Kangaroo, classic (0.099) or 2, as definitions for hookean.

    translated, report = kangaroo.translate(archive.read("tensegrity.gh"), "tensegrity.gh")
    print(report.text())

A solver of Kangaroo and all goals that flow into it are swapped for components of hookean where each of them has a
counterpart; otherwise all of them stay. Every other object stays, and every wire whose ends are still there. Ids of
components, inputs and outputs are kept, so groups and timers go on working. What cannot be translated is in the report,
and in a panel in the file.
"""

from __future__ import annotations

import textwrap
from pathlib import Path
from uuid import UUID, uuid5

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import PANEL, SCRIPT_LIBRARY, TIMER
from hookean_canvas.archive.parts import inputs, outputs, parts, sources
from hookean_canvas.definitions import containers
from hookean_canvas.kangaroo.carried import carry
from hookean_canvas.kangaroo.make import put_object
from hookean_canvas.kangaroo.plan import Importing
from hookean_canvas.kangaroo.report import Report
from hookean_canvas.kangaroo.streams import copied
from hookean_canvas.kangaroo.swap import connect

NOTE = (255, 255, 235, 205)


def import_file(source: Path, target: Path | None = None) -> tuple[Path, Report]:
    """Translate a .gh or .ghx file and write it (none: to `<name>-hookean.ghx` beside it); its path and the report.

    InputError where the file cannot be read, is no definition, or would be written over.
    """
    target = target or source.with_name(f"{source.stem}-hookean.ghx")
    if target.resolve() == source.resolve():
        raise InputError(str(target), "is the input file; give another name")
    translated, report = translate(archive.read(source), source.name)
    archive.write(translated, target)
    return target, report


def translate(root: Chunk, name: str = "definition") -> tuple[Chunk, Report]:
    """A translated copy of a definition, and what was done; InputError where it is no definition."""
    root = copied(root)
    report = Report(name)
    work = Importing(root, report)
    work.run()
    carry(work)
    _rename(work)
    _count(work)
    _libraries(work)
    _header(root)
    _panel(work)
    return root, report


def _rename(work: Importing) -> None:
    """Groups and timers follow ids that changed; wires from outputs that are gone go. All else stays as it was."""
    ports = {
        port.value("InstanceGuid") for part in parts(work.root) if part.container for port in outputs(part.container)
    }
    for part in parts(work.root):
        container = part.container
        if container is None:
            continue
        for port in inputs(container):
            there = [one for one in sources(port) if one in ports or work.streams.owner(one) is None]
            if there != sources(port):
                connect(port, there)
        for item in container.items:
            if item.name in ("ID", "Target"):
                item.value = work.renamed.get(item.value, item.value)
    engines = {
        part.id for part in parts(work.root) if part.container and part.container.value("Name") == "Hookean Engine"
    }
    for part in parts(work.root):
        if (
            part.guid == TIMER
            and part.container
            and engines & {i.value for i in part.container.items if i.name == "Target"}
        ):
            work.report.notes.append(
                f"{part.label} is no longer needed; the Engine solves again by itself while it runs"
            )


def _count(work: Importing) -> None:
    """Which wires of before are there after; the rest is listed, each with its reason."""
    after = {
        (source, port.value("InstanceGuid"))
        for part in parts(work.root)
        if part.container is not None
        for port in inputs(part.container)
        for source in sources(port)
    }
    report = work.report
    for wire in work.streams.wires:
        start, end = (work.renamed.get(one, one) for one in wire)
        if (start, end) in after:
            report.kept += 1
        else:
            why = work.because.get(wire[1]) or work.because.get(wire[0]) or "its end was removed"
            (report.idle if wire[1] in work.idle else report.lost).append((work.streams.told(wire), why))
    report.wires = len(work.streams.wires)
    report.notes += [
        f"the wire {work.streams.told(wire)} comes from nothing in the file" for wire in work.streams.dangling
    ]


def _libraries(work: Importing) -> None:
    """The list of plug-ins names what is used: Kangaroo only where some of it stays, and the scripts of Rhino 8."""
    definition = work.root.chunk("Definition")
    assert definition is not None
    used = {part.chunk.value("Lib") for part in parts(work.root)}
    listed = definition.chunk("GHALibraries") or Chunk("GHALibraries")
    if listed not in definition.chunks:
        definition.chunks.insert(-1, listed)
    listed.chunks = [c for c in listed.chunks if c.value("Id") in used or c.value("Id") not in work.libraries]
    if SCRIPT_LIBRARY in used and SCRIPT_LIBRARY not in {c.value("Id") for c in listed.chunks}:
        library = Chunk("Library").put("Id", Type.GUID, SCRIPT_LIBRARY).put("Name", Type.STRING, "RhinoCodePluginGH")
        library.put("Author", Type.STRING, "Robert McNeel & Associates").put("Version", Type.STRING, "")
        listed.chunks.append(library)
    for i, library in enumerate(listed.chunks):
        library.index = i
    listed.put("Count", Type.INT32, len(listed.chunks))


def _header(root: Chunk) -> None:
    """A document of its own: an id made of the old one, and no picture of the old canvas."""
    definition = root.chunk("Definition")
    header = definition.chunk("DocumentHeader") if definition is not None else None
    if header is not None:
        old = header.value("DocumentID")
        old = old if isinstance(old, UUID) else UUID(int=0)
        header.put("DocumentID", Type.GUID, uuid5(old, "hookean import"))
    root.chunks = [chunk for chunk in root.chunks if chunk.name != "Thumbnail"]


def _panel(work: Importing) -> None:
    """The report as a panel over the definition."""
    text = "\n".join(part for line in work.report.text().split("\n") for part in textwrap.wrap(line, 100) or [""])
    header = work.root.chunk("Definition").chunk("DocumentHeader")  # type: ignore[union-attr]
    document = header.value("DocumentID", default=UUID(int=0)) if header is not None else UUID(int=0)
    chunk = containers.panel(uuid5(document, "hookean report"), "Translated for hookean", text, NOTE)
    x, y = work.space.corner()
    high = 16.0 * (text.count("\n") + 1) + 30.0
    put_object(work.objects, PANEL, chunk)
    work.space.put(chunk, (x, y - high - 40.0, 660.0, high))
