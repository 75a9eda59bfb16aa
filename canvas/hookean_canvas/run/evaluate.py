"""A canvas without Grasshopper: reads a definition and evaluates it, scripts and all, against a live server.

Objects are solved in the order of their wires. Data is matched as Grasshopper matches it (`trees`). The code of script
components is what the file holds; it runs in this process, with stand-ins for Rhino, Grasshopper and ghenv, and
rhino3dm as Rhino.Geometry. Solutions that a component schedules are run until nothing is scheduled any more.

A toggle that feeds an input called reset is pressed as a person presses it: True first, then False. One that feeds the
input called on of an Engine is True. Settings keep both from it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any
from uuid import UUID

import rhino3dm

from hookean.errors import InputError
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE, GRAPH_MAPPER, NUMBER_SLIDER, PANEL, VALUE_LIST
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.components import ignored, inputs_of, native_for, outputs_of, run_native
from hookean_canvas.run.graph import Graph, Node, Port
from hookean_canvas.run.mapping import mapper_of
from hookean_canvas.run.natives import Input, Native, Unfit, as_kind, is_inert
from hookean_canvas.run.natives.expressions import evaluated
from hookean_canvas.run.natives.kinds import kind_of, over_unit_domain, radians
from hookean_canvas.run.scripts import SCRIPTS, Script, code_of, handed, hinted, tree_of
from hookean_canvas.run.trees import ITEM, TREE, Run, Tree, modified, runs
from hookean_canvas.run.unsupported import ENGINE, needed, require_known
from hookean_canvas.run.values import OWN, chosen, hurried

stand_in: Any = untyped
SETTINGS = "settings_"
LONGEST_WAIT = 1.0  # s between scheduled solutions, however long one asks to wait


@dataclass
class Message:
    """A message of a component: its name, `error`, `warning` or `remark`, and the sentence."""

    component: str
    level: str
    text: str


@dataclass
class Outcome:
    """What a run came to: `panels` fed by wires, by their names; messages; whether all is at rest; `engines`, the
    status of each Engine; and those of Engines that are `paused` on their way to rest."""

    panels: dict[str, Tree]
    messages: list[Message]
    solutions: int
    at_rest: bool
    engines: list[str] = field(default_factory=list)
    paused: list[str] = field(default_factory=list)


class Canvas:
    """A definition ready to run; `settings` are values of sliders, toggles, panels and value lists by their names."""

    def __init__(self, graph: Graph, settings: Mapping[str, str] | None = None) -> None:
        self.graph = graph
        self._order = graph.ordered()
        self._aside = require_known(graph)
        self._needed = needed(graph)
        self._document = stand_in.Document(path=str(graph.file) if graph.file else None, identity=str(graph.id))
        self._set = _settings(graph, settings or {})
        self._pressed = [node for node in _toggles(graph, "reset") if node.id not in self._set]
        pressed = {node.id for node in self._pressed}
        for node in _toggles(graph, "on", ENGINE):
            if node.id not in pressed:
                self._set.setdefault(node.id, True)
        self._results: dict[UUID, Tree] = {}
        self._messages: dict[UUID, list[Message]] = {}
        self._scripts: dict[UUID, Script] = {}
        self._solutions = 0
        self._last = _behind_scripts(graph)
        self._postponed: set[UUID] = set()
        with _standing():
            for node in graph.nodes:
                code = code_of(node) if node.guid in SCRIPTS else None
                if code is not None:
                    self._scripts[node.id] = Script(node, code, self._document)
        self._connect()

    def run(self, seconds: float = 120.0, solutions: int = 20_000) -> Outcome:
        """Press what resets, then solve until nothing is scheduled, for at most so long and so often."""
        until = time.monotonic() + seconds
        with _standing():
            at_rest = True
            for state in (True, False) if self._pressed else (None,):
                for node in self._pressed:
                    self._set[node.id] = bool(state)
                at_rest = self._settle(None if self._solutions == 0 else self._pressed, until, solutions)
            for node in self._order:
                if node.id in self._postponed:
                    self._evaluate(node)
            self._postponed.clear()
        messages = [message for node in self._order for message in self._messages.get(node.id, [])]
        panels: dict[str, Tree] = {}
        for node in self._order:
            if node.guid == PANEL and node.inputs[0].sources:
                panels[_free(node.label, panels)] = self._results[node.id]
        engines = [text for node in self._order if node.name == ENGINE for text in self._status(node)]
        paused = [text for text in engines if ": Running:" in text] if at_rest else []
        return Outcome(panels, messages, self._solutions, at_rest and not paused, engines, paused)

    def _status(self, engine: Node) -> list[str]:
        """The status of an Engine; nothing where it has not been run."""
        return [
            f"{engine.label}: {text}"
            for port in engine.outputs
            if port.name == "status"
            for text in self._results[port.id].values_in_order()
        ]

    def _connect(self) -> None:
        """Give each stand-in component the objects behind its wires, as ghenv.Component.Params shows them."""
        owners = self.graph.owners()
        for start, output, _, taker in self.graph.wires():
            if start.id in self._scripts:
                of = self._scripts[start.id].component.Params.Output
                of[start.outputs.index(output)].Recipients.append(taker)
        for script in self._scripts.values():
            for given, port in zip(script.component.Params.Input, script.node.inputs, strict=True):
                given.InstanceGuid = str(port.id)
                for source in port.sources:
                    if source in owners:
                        behind = stand_in.Parameter(owners[source][1].nickname)
                        behind.InstanceGuid = str(source)
                        given.Sources.append(behind)

    def _settle(self, expired: Sequence[Node] | None, until: float, solutions: int) -> bool:
        """Solve what is expired (None: all), and what is scheduled after that; whether it came to rest in time."""
        self._solve(expired)
        while self._document.scheduled:
            if time.monotonic() > until or self._solutions >= solutions:
                return False
            waiting, self._document.scheduled[:] = list(self._document.scheduled), []
            time.sleep(min(LONGEST_WAIT, min(wait for wait, _ in waiting) / 1000.0))
            for script in self._scripts.values():
                script.component.expired = 0
            for _, callback in waiting:
                if callback is not None:
                    self._call(callback)
            again = [script.node for script in self._scripts.values() if script.component.expired]
            self._solve(again)
        return True

    def _call(self, callback: Any) -> None:
        """What a component scheduled; InputError where it raises, as Grasshopper's solution ends there."""
        try:
            callback(self._document)
        except (Exception, SystemExit) as error:
            raise InputError("a scheduled solution", f"{type(error).__name__}: {error}") from None

    def _solve(self, expired: Sequence[Node] | None) -> None:
        """One solution: the expired objects and all that depend on them."""
        self._solutions += 1
        stale = {node.id for node in (self._order if expired is None else expired)}
        after: dict[UUID, list[UUID]] = {}
        for start, _, end, _ in self.graph.wires():
            after.setdefault(start.id, []).append(end.id)
        waiting = list(stale)
        while waiting:
            for key in after.get(waiting.pop(), ()):
                if key not in stale:
                    stale.add(key)
                    waiting.append(key)
        for node in self._order:
            if node.id in stale and node.id in self._last:
                self._postponed.add(node.id)
            elif node.id in stale:
                self._evaluate(node)

    def _evaluate(self, node: Node) -> None:
        self._messages[node.id] = []
        for port in node.outputs:
            self._results[port.id] = Tree()
        if node.locked or is_inert(node.guid, node.name, node.plugin):
            return
        if node.id in self._aside:
            self._say(node, "warning", f"left out, as no Engine needs it: {self._aside[node.id]}")
        elif node.floating:
            self._results[node.id] = self._floating(node)
        elif (native := native_for(node)) is not None:
            self._native(node, native)
        else:
            self._script(node, self._scripts[node.id])

    def _given(self, node: Node, port: Port, cast: Callable[[Any], Any] | None = None) -> Tree:
        """The data that reaches an input, by wires or its own, after its modifiers; an expression on it gets values of
        the kind that the input has (`cast`), as a number of a panel's text."""
        found = Tree()
        for source in port.sources:
            found.take(self._results.get(source, Tree()))
        if not port.sources and port.data is not None:
            found.take(port.data)
        found = modified(found, port.mapping, port.reverse, port.simplify)
        if port.expression:
            found = self._expressed(node, port, found if cast is None else self._converted(node, port, found, cast))
        if port.degrees:
            found = self._converted(node, port, found, radians)
        return found.each(over_unit_domain) if port.unit else found

    def _expressed(self, node: Node, port: Port, tree: Tree) -> Tree:
        """Each value x after the expression that a person has put on the input."""
        return self._converted(
            node, port, tree, lambda x: None if x is None else evaluated(port.expression, _variables(x))
        )

    def _floating(self, node: Node) -> Tree:
        port = node.inputs[0]
        value = self._set.get(node.id)
        if value is not None or (not port.sources and node.guid in OWN):
            own = Tree.of([value] if value is not None else OWN[node.guid](node))
            return self._expressed(node, port, own) if port.expression else own
        mapped = mapper_of(node) if node.guid == GRAPH_MAPPER else None
        kind = kind_of(node.guid, "" if node.plugin else node.name) if mapped is None else "number"
        found = self._given(node, port, None if kind is None else partial(as_kind, kind))
        if mapped is not None:
            return self._cast(node, port, "number", found).each(lambda x: None if x is None else mapped(x))
        return found if kind is None else self._cast(node, port, kind, found)

    def _native(self, node: Node, native: Native) -> None:
        def say(level: str, text: str) -> None:
            """A stand-in may fail where Grasshopper's own would not; what no Engine needs is no error."""
            self._say(node, level if level != "error" or node.id in self._needed else "warning", text)

        if native.remark:
            say("remark", native.remark)
        for text in ignored(node, native):
            say("warning", text)
        given: list[tuple[Input, Tree]] = []
        for port, of in inputs_of(node, native) or []:
            held = Tree.of(of.default) if port is None else self._given(node, port, partial(as_kind, of.kind))
            tree = self._cast(node, port or node.inputs[0], of.kind, held) if held else held
            if port is not None and not tree and not of.optional:
                say("warning", f"Input parameter {port.nickname} failed to collect data")
                return
            given.append((of, tree))
        results = run_native(node, native, given, say)
        for (output, _), tree in zip(outputs_of(node, native) or [], results, strict=True):
            if output is not None:
                found = modified(tree, output.mapping, output.reverse, output.simplify)
                self._results[output.id] = found.each(over_unit_domain) if output.unit else found

    def _script(self, node: Node, script: Script) -> None:
        del script.component.messages[:]
        for wired in script.component.Params.Input:
            for source in wired.Sources:
                source.VolatileData = handed(self._results[UUID(source.InstanceGuid)])
        script.component.RunCount = 0
        given: list[tuple[int, Tree]] = []
        for port in node.inputs:
            tree = self._hinted(node, port, self._given(node, port))
            if node.name == ENGINE and port.name == SETTINGS:
                tree = hurried(tree)
            if not tree and not port.optional:
                self._say(node, "warning", f"Input parameter {port.nickname} failed to collect data")
                return
            given.append((port.access, tree))
        for run in runs(given):
            script.component.RunCount += 1
            self._keep(node, run, script.run(run.values), nested=any(access == ITEM for access, _ in given))
        for level, text in script.component.messages:
            self._say(node, str(level).lower(), text)

    def _keep(self, node: Node, run: Run, values: Sequence[Any], nested: bool) -> None:
        """What a script gave, in the trees of its outputs."""
        for port, value in zip(node.outputs, values, strict=True):
            tree = tree_of(value)
            if tree is not None:
                self._results[port.id].take(tree)
            elif isinstance(value, (list, tuple)):
                self._results[port.id].add((*run.path, run.number) if nested else run.path, list(value))
            elif value is not None:
                self._results[port.id].add(run.path, [value])

    def _cast(self, node: Node, port: Port, kind: str, tree: Tree) -> Tree:
        return self._converted(node, port, tree, lambda value: as_kind(kind, value))

    def _hinted(self, node: Node, port: Port, tree: Tree) -> Tree:
        return self._converted(node, port, tree, lambda value: hinted(port.hint, value))

    def _converted(self, node: Node, port: Port, tree: Tree, convert: Any) -> Tree:
        found = Tree()
        for path, values in tree.branches():
            found[path] = []
            for value in values:
                try:
                    found[path].append(convert(value))
                except Unfit as error:
                    found[path].append(None)
                    self._say(node, "error", f"{port.nickname}: {error}")
        return found

    def _say(self, node: Node, level: str, text: str) -> None:
        self._messages[node.id].append(Message(node.label, level, text))


def _behind_scripts(graph: Graph) -> set[UUID]:
    """The objects that no script depends on, by their ids: what they give is wanted after the last solution only."""
    before: dict[UUID, list[UUID]] = {}
    for start, _, end, _ in graph.wires():
        before.setdefault(end.id, []).append(start.id)
    waiting = [node.id for node in graph.nodes if node.guid in SCRIPTS]
    needed_by_scripts = set(waiting)
    while waiting:
        found = set(before.get(waiting.pop(), ())) - needed_by_scripts
        needed_by_scripts |= found
        waiting += found
    return {node.id for node in graph.nodes} - needed_by_scripts


class _standing:
    """Rhino and Grasshopper in sys.modules are stand-ins, as long as this lasts."""

    def __enter__(self) -> None:
        self._canvas: Any = stand_in.Canvas(geometry=rhino3dm)
        self._canvas.install()

    def __exit__(self, *_: object) -> None:
        self._canvas.remove()


def _free(name: str, taken: Mapping[str, Any]) -> str:
    """A name that nothing has yet: with a number after it where another has the name itself."""
    number = 2
    found = name
    while found in taken:
        found, number = f"{name} ({number})", number + 1
    return found


def _toggles(graph: Graph, name: str, owner: str = "") -> list[Node]:
    """Toggles that feed an input of this name, of an object of the name `owner` where one is given."""
    found: dict[UUID, Node] = {}
    for start, _, end, port in graph.wires():
        if start.guid == BOOLEAN_TOGGLE and owner in ("", end.name) and port.nickname.strip("_").lower() == name:
            found[start.id] = start
    return list(found.values())


def _settings(graph: Graph, given: Mapping[str, str]) -> dict[UUID, Any]:
    """Values given by name, by the objects that have them; InputError for a name or value that does not fit."""
    found: dict[UUID, Any] = {}
    settable = [
        n
        for n in graph.nodes
        if n.guid in (NUMBER_SLIDER, BOOLEAN_TOGGLE, VALUE_LIST, PANEL) and not n.inputs[0].sources
    ]
    settable = [n for n in settable if n.nickname]
    for name, text in given.items():
        nodes = [node for node in settable if node.nickname == name]
        if not nodes:
            known = ", ".join(sorted(node.nickname for node in settable))
            raise InputError(name, f"no input that can be set has this name; there are {known}")
        for node in nodes:
            found[node.id] = chosen(node, text)
    return found


def _variables(x: Any) -> dict[str, Any]:
    """What an expression on an input calls the value: x, or whatever the input is called."""
    return {"x": x, "X": x}


__all__ = ["TREE", "Canvas", "Message", "Outcome"]
