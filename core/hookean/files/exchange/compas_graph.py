"""COMPAS graphs of a result: nodes and edges with results as attributes, for programs that read COMPAS."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from hookean.atomic_write import put
from hookean.files import compas_json
from hookean.files.exchange.structure import Structure


def document(structure: Structure, name: str = "") -> dict[str, Any]:
    """A Graph document. Nodes have `is_support`, `fixed` (axes), loads `px py pz`, reactions `rx ry rz` and
    displacements `dx dy dz`; edges `force_name`, `kind`, `axial_stiffness` and the columns of their force; the graph
    has `units`. Of several elements between two particles the first is an edge."""
    _, first = np.unique(np.sort(structure.pairs, axis=1), axis=0, return_index=True)
    order = np.sort(first)
    made = compas_json.graph(structure.points, structure.pairs[order], name)
    data = made["data"]
    for number, node in enumerate(data["node"].values()):
        held = structure.held[number]
        if held.any():
            node.update(is_support=True, fixed="".join(a for a, on in zip("xyz", held, strict=True) if on))
            node.update(zip(("rx", "ry", "rz"), structure.reactions[number].tolist(), strict=True))
        if structure.loads[number].any():
            node.update(zip(("px", "py", "pz"), structure.loads[number].tolist(), strict=True))
        node.update(zip(("dx", "dy", "dz"), structure.displacements[number].tolist(), strict=True))
    wanted, start = set(order.tolist()), 0
    for group in structure.lines:
        for row, (a, b) in enumerate(group.pairs.tolist()):
            if start + row in wanted:
                edge = data["edge"][str(a)][str(b)]
                edge.update(force_name=group.name, kind=group.kind)
                edge.update({column: float(values[row]) for column, values in group.columns.items()})
                if group.axial_stiffness[row] > 0.0:
                    edge["axial_stiffness"] = float(group.axial_stiffness[row])
        start += len(group.pairs)
    data["attributes"] = {"units": structure.units.model_dump()}
    return made


def write(structure: Structure, target: Path) -> None:
    """Write the graph as JSON."""
    put(target, json.dumps(document(structure), allow_nan=False).encode(), lambda back: None)
