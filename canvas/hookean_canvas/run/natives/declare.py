"""How a native component is declared: one function, with the text of its inputs and outputs.

    @native("1817fd29-20ae-4503-b542-f0fb651e67d7", "List Length", "Lng", "List (L): any list", "Length (L)")
    def list_length(values):
        \"\"\"How many items a list has.\"\"\"
        return len(values)

Inputs are `Name (Nickname): kind access optional = default`, separated by `; `. A kind is one of `kinds`; access is
`list` or `tree`, an item otherwise. Outputs are `Name (Nickname): access`, where `branches` is a list of lists that get
a branch each below the path of the run. The last input or output may end with `...`:
a person may then add more of it. The function takes a value for each input and returns the value of its output, or a
tuple of values for several.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from hookean_canvas.archive import guids
from hookean_canvas.run.trees import ITEM, LIST, TREE

BRANCHES = 3
MOST = 1_000_000  # items, faces or points that one component makes in one run


class Unfit(ValueError):
    """A value that an input cannot take; the message is the component's."""


def bounded(count: float) -> None:
    """Unfit where a component would make more than MOST items."""
    if count > MOST:
        raise Unfit(f"this makes more than {MOST} items; give a lower count")


@dataclass(frozen=True)
class Input:
    """An input of a native component: what it takes, and its default where a person connects nothing."""

    name: str
    nickname: str
    kind: str
    access: int = ITEM
    default: tuple[Any, ...] = ()
    optional: bool = False


@dataclass(frozen=True)
class Output:
    """An output of a native component."""

    name: str
    nickname: str
    access: int = ITEM


@dataclass(frozen=True)
class Native:
    """A native component: `run` takes a value for each input, gives one for each output; `does` is what it copies.

    `more_inputs`, `more_outputs`: a person may add further ones like the last. With `sees` the function also gets the
    object of the definition, as `node`, for what is stored there beside inputs. `foreign`: of a plug-in.
    """

    guid: UUID
    name: str
    nickname: str
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    run: Callable[..., tuple[Any, ...]]
    does: str
    subject: str
    more_inputs: bool = False
    more_outputs: bool = False
    sees: bool = False
    remark: str = ""
    foreign: bool = False


NATIVES: dict[UUID, Native] = {}
"""Every native component that can be run, by its id."""

BY_NAME: dict[str, Native] = {}
"""The same by name; where two have one name, the first that was declared."""

PLUGINS: dict[str, Native] = {}
"""Components whose ids are not known here by their names: of plug-ins, and some of Grasshopper's own."""


def native_of(guid: UUID, name: str, plugin: bool) -> Native | None:
    """The native that stands in for an object, by its id, else by its name; None for an unknown one.

    `plugin`: whether the object is of a plug-in, which may give it the name of one of Grasshopper's own. Spaces and
    capitals in names do not count: versions differ in them.
    """
    found = NATIVES.get(guid) or PLUGINS.get(name)
    if found is None:
        found = next((one for known, one in PLUGINS.items() if _plain(known) == _plain(name)), None)
    return found if found is None or found.guid.int or found.foreign or not plugin else None


def _plain(name: str) -> str:
    return name.replace(" ", "").casefold()


_INPUT = re.compile(r"(.+?) \((\S+)\): (\S+)(?: (list|tree))?( optional)?(?: = (.+))?")
_OUTPUT = re.compile(r"(.+?) \((\S+)\)(?:: (list|tree|branches))?")
_ACCESS = {None: ITEM, "list": LIST, "tree": TREE, "branches": BRANCHES}
_DOTS = "..."


def native(
    guid: str,
    name: str,
    nickname: str,
    inputs: str,
    outputs: str,
    sees: bool = False,
    remark: str = "",
    plugin: bool = False,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Declare a function as native component. `guid` may hold several ids, of versions with equal inputs, or none.

    `remark` is what differs from Grasshopper; the run prints it with the component's messages. `plugin`: it is one of a
    plug-in, known by its name.
    """

    def declared(function: Callable[..., Any]) -> Callable[..., Any]:
        ins, outs = _texts(inputs), _texts(outputs)
        for one in map(UUID, guid.split() or [str(UUID(int=0))]):
            made = Native(
                one, guids.name(one) or name, nickname, tuple(map(_input, ins)), tuple(map(_output, outs)),
                _several(function, len(outs), outputs.endswith(_DOTS)), " ".join((function.__doc__ or "").split()),
                function.__module__.rsplit(".", 1)[-1], inputs.endswith(_DOTS), outputs.endswith(_DOTS), sees, remark,
                plugin,
            )  # fmt: skip
            if not guid:
                PLUGINS[name] = made
                continue
            if made.guid in NATIVES:
                raise ValueError(f"{name}: {NATIVES[made.guid].name} has the same id")
            NATIVES[made.guid] = made
            BY_NAME.setdefault(made.name, made)
        return function

    return declared


def _several(function: Callable[..., Any], count: int, more: bool) -> Callable[..., tuple[Any, ...]]:
    """The function with a tuple as result, whatever the number of its outputs."""
    if count != 1 or more:
        return function
    return lambda *values, **named: (function(*values, **named),)


def _texts(text: str) -> list[str]:
    return [part.strip().removesuffix(_DOTS).strip() for part in text.split("; ") if part.strip()]


def _input(text: str) -> Input:
    found = _INPUT.fullmatch(text)
    if found is None:
        raise ValueError(f"{text!r} does not declare an input")
    name, nickname, kind, access, optional, default = found.groups()
    defaults = () if default is None else (ast.literal_eval(default),)
    return Input(name, nickname, kind, _ACCESS[access], defaults, bool(optional))


def _output(text: str) -> Output:
    found = _OUTPUT.fullmatch(text)
    if found is None:
        raise ValueError(f"{text!r} does not declare an output")
    return Output(found[1], found[2], _ACCESS[found[3]])
