"""Checks of the scripts in Grasshopper files: code that compiles for its language, inputs that it can have."""

from __future__ import annotations

import ast
import functools
import os
import shutil
import subprocess
import warnings
from collections.abc import Iterator
from pathlib import Path
from uuid import UUID

from hookean_canvas.archive import Chunk, guids
from hookean_canvas.archive.chunk import labelled
from hookean_canvas.archive.parts import Code, code, inputs, outputs

RHINO8 = (3, 9)
"""The Python of Rhino 8; what it parses, Rhino 9's 3.13 parses too."""

_COMPILE = """
import sys
try:
    compile(sys.stdin.read() + "\\n", "script", "exec")
    print("compiled")
except SyntaxError:
    print("line %s: %s" % (sys.exc_info()[1].lineno, sys.exc_info()[1].msg))
"""


def script_faults(component: UUID | None, container: Chunk) -> Iterator[str]:
    """What is wrong with the script in a component's container; nothing where there is no script."""
    try:
        found = code(container)
    except ValueError as error:
        yield f"{error}"
        return
    if found is None:
        yield "the script component holds no script (no `CodeInput`, no chunk `Script`)"
        return
    expected = {
        guids.PYTHON3_SCRIPT: "python 3",
        guids.IRONPYTHON_SCRIPT: "python 2",
        guids.GHPYTHON_SCRIPT: "python 2",
    }
    if component in expected and found.language != expected[component]:
        yield f"the script is in {found.language}, the component runs {expected[component]}"
    if found.language.startswith("python"):
        yield from (f"the script does not compile as {found.language}: {fault}" for fault in code_faults(found))
        yield from _name_faults(container)
    data = container.chunk("ParameterData")
    for item in data.items if data is not None else []:
        if item.name in ("InputId", "OutputId") and item.value not in guids.NAMES:
            yield f"{labelled(item.name, item.index)} is {item.value}, which is an unknown kind of parameter"
    for port in inputs(container):
        yield from _hint_faults(port)


def code_faults(found: Code) -> list[str]:
    """Why code does not compile for its language: nothing, or one sentence with the line.

    Python 3 is parsed as Rhino 8's 3.9; Python 2 is compiled by a Python 2.7 where the machine has one, else it has
    to parse as Python 3.
    """
    fault = _python2(found.text) if found.language == "python 2" else None
    if fault is None:
        fault = _python3(found.text)
    return [fault] if fault else []


def _python3(text: str) -> str:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about escapes in strings, which compile
            ast.parse(text, feature_version=RHINO8)
    except SyntaxError as error:
        return f"line {error.lineno}: {error.msg}"
    except (ValueError, RecursionError, MemoryError) as error:
        return str(error) or "it is nested too deep"
    return ""


def _python2(text: str) -> str | None:
    """The error of Python 2.7: "" where it compiles; None where there is no Python 2.7."""
    interpreter = python2()
    if interpreter is None:
        return None
    mark = "﻿" if not text.isascii() else ""  # the byte order mark says UTF-8
    answer = _run(interpreter, mark + text)
    return "" if answer == "compiled" else answer


@functools.cache
def python2() -> str | None:
    """A Python 2.7 of this machine that runs, or None."""
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    found = [str(path) for path in sorted(root.glob("versions/2.7*/bin/python2.7"))]
    for interpreter in [*found, shutil.which("python2.7")]:
        if interpreter and _run(interpreter, "print 2") == "compiled":
            return interpreter
    return None


def _run(interpreter: str, text: str) -> str:
    try:
        done = subprocess.run([interpreter, "-c", _COMPILE], input=text.encode(), capture_output=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"Python 2.7 does not answer ({type(error).__name__})"
    return done.stdout.decode(errors="replace").strip() or done.stderr.decode(errors="replace").strip()[-200:]


def _name_faults(container: Chunk) -> Iterator[str]:
    """A Python script knows its inputs and outputs by their nicknames: each has to be a name, and once."""
    for side, ports in (("input", inputs(container)), ("output", outputs(container))):
        names = [str(port.value("NickName", default="")) for port in ports]
        yield from (f"{side} {name!r} is not a name that a script can use" for name in names if not name.isidentifier())
        yield from (f"{side} {name!r} occurs twice" for name in sorted(set(names)) if names.count(name) > 1)


def _hint_faults(port: Chunk) -> Iterator[str]:
    """The type hint is a known one, and the .NET type written beside it is its own."""
    name, given = port.value("NickName", default=""), port.value("TypeHintID")
    if given is None:
        return
    hint = guids.hint(given) if isinstance(given, UUID) else None
    if hint is None:
        yield f"input {name!r} has the type hint {given}, which is unknown"
        return
    converter = port.chunk("ConverterData")
    if converter is None or hint not in guids.CONVERTERS:
        return
    assembly, type = converter.value("AssemblyName", default=""), converter.value("TypeName", default="")
    expected = guids.CONVERTERS[hint]
    if (str(assembly).split(",")[0], type) != expected:
        yield f"input {name!r} is hinted as {hint}, that is {expected[1]}, but is converted to {type} of {assembly}"
