"""Running the code of script components as it stands in a definition, with stand-ins for Rhino and Grasshopper."""

from __future__ import annotations

import base64
import binascii
import contextlib
import io
import traceback
import warnings
from collections.abc import Sequence
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive.guids import GHPYTHON_SCRIPT, PYTHON3_SCRIPT, SCRIPT, hint
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.graph import Node
from hookean_canvas.run.natives import Unfit, as_kind
from hookean_canvas.run.trees import Tree, path_of

stand_in: Any = untyped
SCRIPTS = (PYTHON3_SCRIPT, SCRIPT, GHPYTHON_SCRIPT)
"""Components whose code is Python: Python 3 Script, Script with Python in it, GhPython."""

_KINDS = {
    "float": "number", "int": "integer", "bool": "boolean", "str": "text", "point": "point", "vector": "vector",
    "line": "line", "curve": "curve", "mesh": "mesh", "plane": "plane",
}  # fmt: skip


def code_of(node: Node) -> str | None:
    """The Python code in a script component; None where it is another language's or there is none."""
    if node.guid == GHPYTHON_SCRIPT:
        plain = node.container.value("CodeInput")
        return plain if isinstance(plain, str) else None
    script = node.container.chunk("Script")
    if script is None:
        return None
    language = script.chunk("LanguageSpec")
    if language is not None and "python" not in str(language.value("Taxon", default="")):
        return None
    try:
        return base64.b64decode(str(script.value("Text")), validate=True).decode("utf-8")
    except (binascii.Error, ValueError):
        raise InputError(node.label, "its code is not base64 of UTF-8; the file is damaged") from None


class Script:
    """A script component of a definition: compiled once, run for each branch or item, its component stands in."""

    def __init__(self, node: Node, code: str, document: Any) -> None:
        self.node = node
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # about escapes in strings, which compile
                self._code = compile(code, f"<{node.label}>", "exec", dont_inherit=True)
        except SyntaxError as error:
            raise InputError(f"{node.label}, line {error.lineno}", f"its code does not compile: {error.msg}") from None
        except (ValueError, RecursionError, MemoryError) as error:
            raise InputError(node.label, f"its code does not compile: {error or 'it is nested too deep'}") from None
        self.component = stand_in.Component(
            node.name, node.label, [p.nickname for p in node.inputs], [p.nickname for p in node.outputs],
            guid=str(node.id), document=document,
        )  # fmt: skip
        self._environment = stand_in.Environment(self.component)
        self.printed = ""

    def run(self, values: Sequence[Any]) -> list[Any]:
        """One run: what the script left in each of its outputs. What it raises becomes an error on the component."""
        names: dict[str, Any] = {"__name__": "__main__", "ghenv": self._environment}
        for port, value in zip(self.node.inputs, values, strict=True):
            names[port.nickname] = handed(value)
        names.update({port.nickname: None for port in self.node.outputs})
        said = io.StringIO()
        try:
            with contextlib.redirect_stdout(said):
                exec(self._code, names)
        except (Exception, SystemExit) as error:
            line = next(
                (
                    f.lineno
                    for f in reversed(traceback.extract_tb(error.__traceback__))
                    if f.filename == f"<{self.node.label}>"
                ),
                0,
            )
            self.fail(f"{type(error).__name__}: {error} [line {line}]")
            return [None] * len(self.node.outputs)
        self.printed += said.getvalue()
        return [names.get(port.nickname) for port in self.node.outputs]

    def fail(self, sentence: str) -> None:
        """Put an error on the component."""
        self.component.messages.append(("error", sentence))


def hinted(port_hint: UUID | None, value: Any) -> Any:
    """A value as the type hint of an input asks for it; Unfit where it cannot be."""
    kind = _KINDS.get(hint(port_hint) or "") if port_hint is not None else None
    return value if kind is None or value is None else as_kind(kind, value)


def handed(value: Any) -> Any:
    """Trees as Grasshopper's DataTree; everything else as it is."""
    if not isinstance(value, Tree):
        return value
    tree = stand_in.DataTree()
    for path, values in value.branches():
        tree.AddRange(values, stand_in.GH_Path(*path))
    return tree


def tree_of(value: Any) -> Tree | None:
    """A DataTree that a script gave as a Tree; None for anything else."""
    if not hasattr(value, "Paths") or not hasattr(value, "Branch"):
        return None
    found = Tree()
    for path in value.Paths:
        found.add(path_of(str(path)), list(value.Branch(path)))
    return found


__all__ = ["SCRIPTS", "Script", "Unfit", "code_of", "hinted", "tree_of"]
