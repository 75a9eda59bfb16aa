"""Clusters opened: what is in them takes their place, so that it runs as on the canvas.

Inputs and outputs of a cluster belong to the objects Cluster Input and Cluster Output in it: by their nicknames where
these are the same, else from top to bottom, the order in which Grasshopper makes them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from uuid import UUID, uuid5

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive.chunk import CLUSTERS
from hookean_canvas.archive.guids import CLUSTER, PARAMETERS
from hookean_canvas.run import graph
from hookean_canvas.run.graph import Graph, Node, Port
from hookean_canvas.run.internalised import unreadable
from hookean_canvas.run.stored import NOTHING, internalised_in

HOOKS = ("Cluster Input", "Cluster Output")
MOST_OBJECTS = 20_000
"""Objects that a definition may have once its clusters are open."""


def opened(definition: Graph) -> Graph:
    """A definition with its clusters opened, and those in them; one that cannot be opened stays as it is."""
    nodes = [*definition.nodes]
    for _ in range(CLUSTERS):
        if not any(node.guid == CLUSTER for node in nodes):
            break
        found: list[Node] = []
        for node in nodes:
            found += _opened(node) or [node]
        if len(found) > MOST_OBJECTS:
            raise InputError(
                definition.name or "clusters", f"has more than {MOST_OBJECTS} objects with those in clusters"
            )
        if len(found) == len(nodes):
            break
        nodes = found
    return replace(definition, nodes=nodes)


def why_closed(node: Node) -> str:
    """Why a cluster is not opened."""
    inside = _inside(node)
    if inside is None:
        return "its document cannot be read; it may have a password"
    counts = [sum(one.name == hook for one in inside.nodes) for hook in HOOKS]
    return f"it has {len(node.inputs)} inputs and {len(node.outputs)} outputs, and {counts[0]} and {counts[1]} inside"


def _inside(node: Node) -> Graph | None:
    document = node.container.value("ClusterDocument")
    if not isinstance(document, bytes):
        return None
    try:
        root = archive.of_bytes(document, "cluster")
        held = internalised_in(root)
        return graph.of(root, "cluster", unreadable(held) if held else NOTHING)
    except InputError:
        return None


def _opened(node: Node) -> list[Node]:
    """The objects in a cluster, wired to what the cluster was wired to; none where it cannot be opened."""
    inside = _inside(node) if node.guid == CLUSTER else None
    if inside is None:
        return []
    hooks = [[one for one in inside.nodes if one.name == name and one.floating] for name in HOOKS]
    ports = node.inputs, node.outputs
    if any(len(one) != len(other) for one, other in zip(hooks, ports, strict=True)):
        return []
    names = {port.id: uuid5(node.id, str(port.id)) for one in inside.nodes for port in (*one.inputs, *one.outputs)}
    made = [_renamed(one, node, names) for one in inside.nodes]
    of = {one.id: one for one in made}
    for port, hook in _pairs(node.inputs, hooks[0]):
        place = of[uuid5(node.id, str(hook.id))]
        outer = replace(port, id=uuid5(node.id, f"into {port.id}"))
        made.append(_relay(node, outer))
        place.inputs[0].sources = [outer.id]
    for port, hook in _pairs(node.outputs, hooks[1]):
        made.append(_relay(node, replace(port, sources=[names[hook.outputs[0].id]])))
    return made


def _renamed(one: Node, cluster: Node, names: Mapping[UUID, UUID]) -> Node:
    """An object of a cluster with ids of its own, as one cluster may be there several times."""
    new = [
        [replace(port, id=names[port.id], sources=[names.get(s, s) for s in port.sources]) for port in side]
        for side in (one.inputs, one.outputs)
    ]
    if one.floating:
        new[1] = new[0]
    guid = PARAMETERS["Data"] if one.name in HOOKS and one.floating else one.guid
    return replace(one, id=uuid5(cluster.id, str(one.id)), guid=guid, inputs=new[0], outputs=new[1],
                   locked=one.locked or cluster.locked)  # fmt: skip


def _pairs(ports: Sequence[Port], hooks: Sequence[Node]) -> list[tuple[Port, Node]]:
    by_name = {hook.nickname: hook for hook in hooks}
    if len(by_name) == len(hooks) and {port.nickname for port in ports} == set(by_name):
        return [(port, by_name[port.nickname]) for port in ports]
    return list(zip(ports, sorted(hooks, key=lambda hook: (hook.bounds or (0, 0, 0, 0))[1]), strict=True))


def _relay(cluster: Node, port: Port) -> Node:
    """A parameter in the place of a cluster's input or output."""
    label = f"{cluster.label}, {port.nickname or port.name}"
    return Node(port.id, PARAMETERS["Data"], "Data", label, cluster.container, [port], [port], cluster.bounds,
                cluster.locked)  # fmt: skip
