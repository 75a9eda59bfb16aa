"""What of a definition cannot be run without Grasshopper: all of it at once, a line for each kind of object."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import guids
from hookean_canvas.run.clusters import why_closed
from hookean_canvas.run.components import inputs_of, native_for, outputs_of
from hookean_canvas.run.graph import Graph, Node
from hookean_canvas.run.mapping import UNKNOWN, mapper_of
from hookean_canvas.run.natives import PARAMETERS, is_inert
from hookean_canvas.run.natives.display import SWATCH
from hookean_canvas.run.natives.kinds import kind_of
from hookean_canvas.run.scripts import SCRIPTS, code_of
from hookean_canvas.run.stored import Unread
from hookean_canvas.run.trees import Tree
from hookean_canvas.run.values import OWN

VALUES = (
    guids.NUMBER_SLIDER, guids.BOOLEAN_TOGGLE, guids.PANEL, guids.VALUE_LIST, guids.BUTTON, guids.RELAY,
    guids.PARAM_VIEWER, guids.TIMER, guids.GENE_POOL, guids.DIGIT_SCROLLER, guids.CONTROL_KNOB, SWATCH,
)  # fmt: skip
"""Objects that hold or pass on values, besides parameters."""
OWN_NUMBER = (guids.GENE_POOL, guids.DIGIT_SCROLLER, guids.CONTROL_KNOB)
"""Objects that hold numbers in a way that versions of Grasshopper may write differently."""
PASSING = ("Data Recorder",)
"""Objects that are known by their names and hand on what they get."""


TRANSLATED = ("kangaroo", "k2engineering")
"""How names of the plug-ins begin whose components `hookean canvas import` translates."""
ENGINE = "Hookean Engine"
CARRIED = "geometry_"
"""The input of an Engine for what moves with the particles."""

_STORED = "how files store its values is not published; put them on a panel instead"
_KERNEL = "it needs Rhino's kernel; internalise what it gives in Grasshopper"
_DOCUMENT = "it reads the open document of Rhino; internalise what it gives in Grasshopper"
_CODE = "its code is not Python"
_WHY = {
    _STORED: ("MD Slider", "Calendar", "Path Mapper"),
    _KERNEL: (
        "Solid Union", "Solid Difference", "Solid Intersection", "Mesh Union", "Mesh Difference",
        "Mesh Intersection", "Mesh Split", "Split Brep",
        "Split Brep Multiple", "Surface Split", "Split with Brep", "Split with Breps", "Trim with Brep",
        "Trim with Breps", "Trim Solid", "Boundary Volume", "Brep | Brep", "Cap Holes Ex", "Fillet", "Fillet Edge",
        "Pipe Variable", "SubD from Mesh", "Quad Remesh", "Copy Trim", "Retrim", "Geodesic", "Text On Surface",
    ),
    _DOCUMENT: ("Geometry Pipeline", "Geometry Cache", "Image Sampler", "Import Image", "Object Details"),
    _CODE: ("C# Script", "VB Script"),
}  # fmt: skip
REASONS: dict[str, str] = {name: why for why, names in _WHY.items() for name in names}
"""Why Grasshopper's own objects have no stand-in, where there is more to say than that."""


def require_known(graph: Graph) -> dict[UUID, str]:
    """Why objects that no Engine needs cannot be run, by their ids; they are left out.

    InputError for a damaged file, and for one with other objects or stored data that cannot be run; a fault for each.
    Where there is no Engine, all objects are needed.
    """
    where = str(graph.file or graph.name)
    if graph.damage:
        raise InputError(where, f"the file is damaged: {'; '.join(graph.damage)}")
    wanted, aside = needed(graph), {}
    counted: Counter[tuple[str, str]] = Counter()
    for node, what, why in _unknown(graph):
        if node.id in wanted:
            counted[what, why] += 1
        else:
            aside[node.id] = why
    faults = [InputError(f"{count} x {what}", why) for (what, why), count in counted.most_common()]
    if faults:
        listed = "; ".join(map(str, faults))
        raise InputError(where, f"nothing was run; these cannot be run without Grasshopper: {listed}", faults)
    return aside


def unsupported(graph: Graph) -> Counter[tuple[str, str]]:
    """How many objects and stored values there are of each kind that cannot be run: what it is, and why."""
    return Counter((what, why) for _, what, why in _unknown(graph))


def needed(graph: Graph) -> set[UUID]:
    """The objects that an Engine's shape depends on, by their ids; all where there is no Engine.

    What an Engine carries along is only shown, and what a disabled object would take is not used.
    """
    running = [node.id for node in graph.nodes if not node.locked]
    waiting = [node.id for node in graph.nodes if node.name == ENGINE and not node.locked] or running
    before: dict[UUID, list[UUID]] = {}
    for start, _, end, port in graph.wires():
        if not (start.locked or end.locked or (end.name == ENGINE and port.name == CARRIED)):
            before.setdefault(end.id, []).append(start.id)
    wanted = set(waiting)
    while waiting:
        found = set(before.get(waiting.pop(), ())) - wanted
        wanted |= found
        waiting += found
    return wanted


def _unknown(graph: Graph) -> Iterator[tuple[Node, str, str]]:
    """Each object or stored value that cannot be run: the object, what it is, and why."""
    for node in graph.nodes:
        if node.locked:
            continue
        why = _strange(node)
        if why:
            yield node, node.name, why
        for port in node.inputs if not why and not is_inert(node.guid, node.name, node.plugin) else ():
            odd = [value for value in (port.data or Tree()).values_in_order() if isinstance(value, Unread)]
            if not port.sources:
                what = node.name if node.floating else f"{node.name}, {port.name or port.nickname}"
                for value in odd:
                    yield node, f"data stored in {what}", value.why or f"stored as {', '.join(value.items)}"


def _strange(node: Node) -> str:
    """Why an object has no stand-in; empty where it has one."""
    if is_inert(node.guid, node.name, node.plugin):
        return ""
    if node.guid == guids.GRAPH_MAPPER:
        return "" if mapper_of(node) is not None else UNKNOWN
    if node.guid in OWN_NUMBER and not node.inputs[0].sources and not OWN[node.guid](node):
        return _STORED
    if node.guid in SCRIPTS:
        return "" if code_of(node) is not None else "its code is not Python"
    native = native_for(node)
    if native is not None:
        if inputs_of(node, native) is not None and outputs_of(node, native) is not None:
            return ""
        held, usual = (f"{len(one.inputs)} inputs and {len(one.outputs)} outputs" for one in (node, native))
        return f"it has {held}, not {usual}"
    own = "" if node.plugin else node.name
    if node.floating and (own in PASSING or kind_of(node.guid, own)):
        return ""
    if node.guid in PARAMETERS or node.guid in VALUES:
        return "" if node.floating else "it has inputs or outputs of its own"
    if node.guid == guids.CLUSTER:
        return why_closed(node)
    if node.name in REASONS:
        return REASONS[node.name]
    if node.library.lower().startswith(TRANSLATED):
        return f"it is of {node.library}; translate the file first, with `hookean canvas import`"
    return f"the plug-in {node.library} has no stand-in" if node.library else f"{node.guid} has no stand-in"
