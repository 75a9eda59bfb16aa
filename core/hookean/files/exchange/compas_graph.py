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
    """A Graph document. Nodes have `is_support`, `fixed` (axes), `clamped` (rotations about axes), loads `px py pz` and
    their moments `mx my mz`, reactions `rx ry rz` and their moments `rmx rmy rmz`, the stiffness of elastic supports
    `kx ky kz` and about axes `kmx kmy kmz`, and displacements `dx dy dz`; edges `force_name`, `kind`, `material` and
    `section` by name, `axial_stiffness` and the columns of their force; the graph has `units`. Of several elements
    between two particles the first is an edge."""
    _, first = np.unique(np.sort(structure.pairs, axis=1), axis=0, return_index=True)
    order = np.sort(first)
    made = compas_json.graph(structure.points, structure.pairs[order], name)
    data = made["data"]
    for number, node in enumerate(data["node"].values()):
        held, clamped = (_axes(of[number]) for of in (structure.held, structure.clamped))
        along, about = np.split(structure.elastic[number], 2)
        if held:
            node.update(is_support=True, fixed=held)
        if clamped:
            node.update(is_support=True, clamped=clamped)
        if along.any():
            node.update(zip(("kx", "ky", "kz"), along.tolist(), strict=True))
        if about.any():
            node.update(zip(("kmx", "kmy", "kmz"), about.tolist(), strict=True))
        if held or along.any():
            node.update(zip(("rx", "ry", "rz"), structure.reactions[number].tolist(), strict=True))
        if clamped or about.any():
            node.update(zip(("rmx", "rmy", "rmz"), structure.reaction_moments[number].tolist(), strict=True))
        if structure.loads[number].any():
            node.update(zip(("px", "py", "pz"), structure.loads[number].tolist(), strict=True))
        if structure.moments[number].any():
            node.update(zip(("mx", "my", "mz"), structure.moments[number].tolist(), strict=True))
        node.update(zip(("dx", "dy", "dz"), structure.displacements[number].tolist(), strict=True))
    wanted, start = set(order.tolist()), 0
    for group in structure.lines:
        for row, (a, b) in enumerate(group.pairs.tolist()):
            if start + row in wanted:
                edge = data["edge"][str(a)][str(b)]
                edge.update(force_name=group.name, kind=group.kind)
                edge.update({n: of for n, of in zip(("material", "section"), group.made_of, strict=True) if of})
                edge.update({column: float(values[row]) for column, values in group.columns.items()})
                if group.axial_stiffness[row] > 0.0:
                    edge["axial_stiffness"] = float(group.axial_stiffness[row])
        start += len(group.pairs)
    data["attributes"] = {"units": structure.units.model_dump()}
    return made


def _axes(on: Any) -> str:
    return "".join(axis for axis, held in zip("xyz", on, strict=True) if held)


def write(structure: Structure, target: Path) -> None:
    """Write the graph as JSON."""
    put(target, json.dumps(document(structure), allow_nan=False).encode(), lambda back: None)
