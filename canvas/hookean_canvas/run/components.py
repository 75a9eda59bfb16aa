"""Native components of a definition: their inputs and outputs found by place or name, and their runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from hookean_canvas.run.graph import Node, Port
from hookean_canvas.run.natives import NATIVES, Native, Unfit, native_of, shapes
from hookean_canvas.run.natives.declare import BRANCHES, Input, Output
from hookean_canvas.run.trees import ITEM, LIST, TREE, Path, Run, Tree, runs

Say = Callable[[str, str], None]
EVERY = frozenset(["Collapsed", "Hidden", "IconDisplay", "IconOverride", "Locked", "Optional", "Selected"])
"""Switches and numbers that any component has, without effect on what it does."""


def native_for(node: Node) -> Native | None:
    """The native that stands in for an object; for an older version of one, with an id of its own, the present one.

    Grasshopper's own objects are taken for older versions where the name agrees, and the present one has each of their
    inputs and outputs by its name or nickname; what they lack has a default or is optional.
    """
    found = native_of(node.guid, node.name, node.plugin)
    if found is not None or node.plugin or node.floating:
        return found
    return next((one for one in NATIVES.values() if one.name == node.name and _older(node, one)), None)


def _older(node: Node, native: Native) -> bool:
    inputs = _named(node.inputs, native.inputs)
    spare = inputs is not None and all(port is not None or of.optional or of.default for port, of in inputs)
    return spare and _named(node.outputs, native.outputs) is not None


def inputs_of(node: Node, native: Native) -> list[tuple[Port | None, Input]] | None:
    """The declared inputs with those of the object; None where they do not belong together.

    By their places where their numbers agree or a person may add some; else, and in older versions, by their names.
    What the object lacks is optional, or in an older version has a default.
    """
    declared = list(native.inputs)
    known = node.guid == native.guid or _named(node.inputs, declared) is None
    if known and native.more_inputs and len(node.inputs) >= len(declared) - 1:
        declared += declared[-1:] * (len(node.inputs) - len(declared))
        return list(zip(node.inputs, declared, strict=False))
    if known and len(node.inputs) == len(declared):
        return list(zip(node.inputs, declared, strict=True))
    named = _named(node.inputs, declared)
    older = node.guid != native.guid
    if named is None or any(port is None and not (of.optional or older and of.default) for port, of in named):
        return None
    return named


def outputs_of(node: Node, native: Native) -> list[tuple[Port | None, Output]] | None:
    """The declared outputs with those of the object, which may lack some; None where they do not belong together."""
    declared = list(native.outputs)
    if native.more_outputs:
        declared += declared[-1:] * (len(node.outputs) - len(declared))
        return list(zip(node.outputs, declared, strict=False))
    named = _named(node.outputs, declared)
    if len(node.outputs) == len(declared) and (node.guid == native.guid or named is None):
        return list(zip(node.outputs, declared, strict=True))
    return named


def _named(ports: Sequence[Port], declared: Sequence[Any]) -> list[tuple[Port | None, Any]] | None:
    """Declared inputs or outputs with those of an object by their names, or else nicknames; None where one is left."""
    rest = list(ports)
    found: dict[int, Port] = {}
    for name in (_full, _short):
        for k, of in enumerate(declared):
            port = next((p for p in rest if k not in found and name(p) == name(of)), None)
            if port is not None:
                rest.remove(port)
                found[k] = port
    return [(found.get(k), of) for k, of in enumerate(declared)] if not rest else None


def ignored(node: Node, native: Native) -> list[str]:
    """Sentences on what a person has chosen in the menu of a component that its stand-in does not look at: numbers and
    switches in the file that are not 0, beside those that every component has."""
    if node.container is None or native.sees:
        return []
    chosen = {item.name: item.value for item in node.container.items if type(item.value) in (bool, int) and item.value}
    return [
        f"its option {name} = {value} is not taken into account"
        for name, value in chosen.items()
        if name not in EVERY and not name.endswith("Count")
    ]


def _full(port: Any) -> str:
    return str(port.name).lower()


def _short(port: Any) -> str:
    return str(port.nickname)


def run_native(node: Node, native: Native, given: Sequence[tuple[Input, Tree]], say: Say) -> list[Tree]:
    """Trees for the declared outputs; `given` has the data of each declared input."""
    with shapes.kept(value for _, tree in given for value in tree.values_in_order()):
        return _run_native(node, native, given, say)


def _run_native(node: Node, native: Native, given: Sequence[tuple[Input, Tree]], say: Say) -> list[Tree]:
    outputs = outputs_of(node, native) or []
    results = [Tree() for _ in outputs]
    accesses = [of.access for of, _ in given]
    matched = list(runs([(of.access, tree) for of, tree in given]))
    several = {run.path for run in matched if run.number}
    for run in matched:
        empty = [i for i in run.lacking if accesses[i] == ITEM and not given[i][0].optional]
        if empty:
            for tree in results:
                tree.add(run.path, [])
            continue
        nested = LIST not in accesses and ITEM in accesses or run.path in several
        _keep(results, outputs, run, _values(node, native, given, run, say), nested)
    return results


def _values(
    node: Node, native: Native, given: Sequence[tuple[Input, Tree]], run: Run, say: Say
) -> Sequence[Any] | None:
    """What a run gives; None where a needed item is null, or the component reports an error."""
    values = []
    for i, ((of, _), value) in enumerate(zip(given, run.values, strict=True)):
        if value is None and of.access == ITEM and not of.optional:
            return None
        values.append(None if i in run.lacking and of.optional and of.access == LIST else value)
    try:
        return native.run(*values, node=node) if native.sees else native.run(*values)
    except Unfit as error:
        say("error", str(error))
    except (ArithmeticError, ValueError, TypeError, IndexError, RuntimeError) as error:
        say("error", f"Solution exception: {error or type(error).__name__}")
    except (AttributeError, KeyError):
        say("error", "Solution exception: an item is null, or not of the kind that is needed")
    except MemoryError:
        say("error", "Solution exception: the memory does not suffice for the result")
    return None


def _keep(
    results: list[Tree], outputs: Sequence[tuple[Port | None, Output]], run: Run, values: Sequence[Any] | None,
    nested: bool,
) -> None:  # fmt: skip
    """Put what a run gave into the trees; an item is null where it gave nothing."""
    below: Path = (*run.path, run.number) if nested else run.path
    for k, (tree, (_, of)) in enumerate(zip(results, outputs, strict=True)):
        if values is None or k >= len(values):
            tree.add(run.path if of.access == ITEM else below, [None] if of.access == ITEM else [])
        elif of.access == TREE:
            tree.take(values[k])
        elif of.access == BRANCHES:
            for number, branch in enumerate(values[k]):
                tree.add((*below, number), branch)
        elif of.access == LIST:
            tree.add(below, values[k])
        else:
            tree.add(run.path, [values[k]])
