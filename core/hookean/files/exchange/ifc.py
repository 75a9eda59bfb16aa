"""IFC files: the structural analysis model of a result, with members, supports, loads and results as properties."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import NAMESPACE_URL, uuid5

import numpy as np
from numpy.typing import NDArray

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.files.exchange.beams import Beams
from hookean.files.exchange.ifc_sections import Made
from hookean.files.exchange.structure import Structure
from hookean.files.optional import needed

Floats = NDArray[np.float64]

PREFIXES = {"mm": "MILLI", "cm": "CENTI", "dm": "DECI", "m": None, "km": "KILO"}
ELASTIC = (*["IfcLinearStiffnessMeasure"] * 3, *["IfcRotationalStiffnessMeasure"] * 3)
FORCES = {"N": None, "kN": "KILO", "MN": "MEGA"}


def write(structure: Structure, target: Path) -> None:
    """Write an IFC4 structural analysis model: a curve member for each line element, named after its force, with its
    numbers in a property set, its material and profile, beams rigidly joined but for their releases, with their
    eccentric ends; a point connection for each particle, held ones with their fixed axes and rotations, or the
    stiffness of elastic supports, and reaction; a point action for each load.

    Raises InputError for units that IFC's SI units do not have.
    """
    ifcopenshell = needed("ifcopenshell", "ifc", target.name)
    length, force = str(structure.units.length), str(structure.units.force)
    if length not in PREFIXES or force not in FORCES:
        allowed = f"{', '.join(PREFIXES)} and {', '.join(FORCES)}"
        raise InputError(target.name, f"units {length} and {force} given; IFC files are written in {allowed}")
    writer = _Writer(ifcopenshell, structure, target.stem)
    writer.write()
    put(target, writer.file.to_string().encode(), lambda back: None)


class _Writer:
    def __init__(self, ifcopenshell: Any, structure: Structure, name: str) -> None:
        self.tools, self.structure, self.name = ifcopenshell, structure, name
        self.file = ifcopenshell.file(schema="IFC4")
        self.count = 0
        header = self.file.header.file_name
        header.time_stamp = "1970-01-01T00:00:00"  # the same content, the same bytes
        header.name = name

    def root(self, kind: str, name: str, **more: Any) -> Any:
        """An entity with an identity, which depends on its place in the file alone."""
        self.count += 1
        own = self.tools.guid.compress(uuid5(NAMESPACE_URL, f"hookean/{self.name}/{self.count}").hex)
        return self.file.create_entity(kind, GlobalId=own, Name=name, **more)

    def write(self) -> None:
        make, s = self.file.create_entity, self.structure
        zero = make("IfcCartesianPoint", Coordinates=(0.0, 0.0, 0.0))
        axes = make("IfcAxis2Placement3D", Location=zero)
        context = make("IfcGeometricRepresentationContext", ContextType="Model", CoordinateSpaceDimension=3,
                       Precision=1e-6, WorldCoordinateSystem=axes)  # fmt: skip
        units = [
            make("IfcSIUnit", UnitType="LENGTHUNIT", Name="METRE", Prefix=PREFIXES[str(s.units.length)]),
            make("IfcSIUnit", UnitType="FORCEUNIT", Name="NEWTON", Prefix=FORCES[str(s.units.force)]),
        ]
        torque = [make("IfcDerivedUnitElement", Unit=unit, Exponent=1) for unit in units]
        stiff = [make("IfcDerivedUnitElement", Unit=unit, Exponent=e) for unit, e in zip(units, (-1, 1), strict=True)]
        units.append(make("IfcDerivedUnit", Elements=stiff, UnitType="LINEARSTIFFNESSUNIT"))
        units += [
            make("IfcDerivedUnit", Elements=torque, UnitType=kind) for kind in ("TORQUEUNIT", "ROTATIONALSTIFFNESSUNIT")
        ]
        project = self.root("IfcProject", self.name, RepresentationContexts=[context],
                            UnitsInContext=make("IfcUnitAssignment", Units=units))  # fmt: skip
        place = make("IfcLocalPlacement", RelativePlacement=axes)
        loads = self.root("IfcStructuralLoadCase", "loads", PredefinedType="LOAD_CASE", ActionType="NOTDEFINED",
                          ActionSource="NOTDEFINED")  # fmt: skip
        model = self.root("IfcStructuralAnalysisModel", self.name, PredefinedType="LOADING_3D", LoadedBy=[loads],
                          SharedPlacement=place)  # fmt: skip
        self.root("IfcRelDeclares", "", RelatingContext=project, RelatedDefinitions=[model])
        vertices = [
            make("IfcVertexPoint", VertexGeometry=make("IfcCartesianPoint", Coordinates=tuple(p)))
            for p in s.points.tolist()
        ]
        connections = [self._connection(context, i, vertex) for i, vertex in enumerate(vertices)]
        members = self._members(context, vertices, connections)
        self.root("IfcRelAssignsToGroup", "", RelatedObjects=[*connections, *members], RelatingGroup=model)
        actions = self._actions(connections)
        if actions:
            self.root("IfcRelAssignsToGroup", "", RelatedObjects=actions, RelatingGroup=loads)

    def _shape(self, context: Any, item: Any, kind: str) -> Any:
        given = {"RepresentationIdentifier": "Reference", "RepresentationType": kind, "Items": [item]}
        made = self.file.create_entity("IfcTopologyRepresentation", ContextOfItems=context, **given)
        return self.file.create_entity("IfcProductDefinitionShape", Representations=[made])

    def _connection(self, context: Any, number: int, vertex: Any) -> Any:
        held, condition = [*self.structure.held[number], *self.structure.clamped[number]], None
        elastic = self.structure.elastic[number].tolist()
        if any(held) or any(elastic):
            fixed = [
                self.file.create_entity(*(("IfcBoolean", bool(fast)) if fast or not k else (kind, k)))
                for fast, k, kind in zip(held, elastic, ELASTIC, strict=True)
            ]
            condition = self.file.create_entity("IfcBoundaryNodeCondition", "support", *fixed)
        shape = self._shape(context, vertex, "Vertex")
        made = self.root("IfcStructuralPointConnection", f"particle {number}", Representation=shape,
                         AppliedCondition=condition)  # fmt: skip
        if condition is not None:
            numbers, units = self.structure.reactions[number].tolist(), self.structure.units
            told = {f"reaction {a} [{units.force}]": c for a, c in zip("xyz", numbers, strict=True)}
            if any(held[3:]) or any(elastic[3:]):
                numbers, unit = self.structure.reaction_moments[number].tolist(), units.of("force length")
                told.update({f"reaction moment {a} [{unit}]": c for a, c in zip("xyz", numbers, strict=True)})
            self._properties(made, told)
        return made

    def _members(self, context: Any, vertices: list[Any], connections: list[Any]) -> list[Any]:
        members, beams, made = [], iter(self.structure.beams), Made(self.structure, self.file.create_entity)
        up = self.file.create_entity("IfcDirection", DirectionRatios=(0.0, 0.0, 1.0))
        side = self.file.create_entity("IfcDirection", DirectionRatios=(1.0, 0.0, 0.0))
        for group in self.structure.lines:
            along = self.structure.points[group.pairs[:, 1]] - self.structure.points[group.pairs[:, 0]]
            steep = np.abs(along[:, 2]) > 0.99 * np.linalg.norm(along, axis=1)
            rigid = next(beams) if group.kind == "beam" else None
            for row, (a, b) in enumerate(group.pairs.tolist()):
                edge = self.file.create_entity("IfcEdge", EdgeStart=vertices[a], EdgeEnd=vertices[b])
                kind, axis = "CABLE" if group.force[row] > 0.0 else "PIN_JOINED_MEMBER", side if steep[row] else up
                if rigid is not None:
                    kind, axis = "RIGID_JOINED_MEMBER", self._direction(rigid.axes[row, 2])
                member = self.root(
                    "IfcStructuralCurveMember", f"{group.name} {row}", ObjectType=group.name, PredefinedType=kind,
                    Representation=self._shape(context, edge, "Edge"), Axis=axis,
                )  # fmt: skip
                for end, particle in enumerate((a, b)):
                    joint = {"RelatingStructuralMember": member, "RelatedStructuralConnection": connections[particle]}
                    self._join(joint, rigid, row, end, vertices[particle])
                units = self.structure.units
                self._properties(
                    member,
                    {
                        f"{name} [{units.of(group.dimensions[name]) or '-'}]": float(values[row])
                        for name, values in group.columns.items()
                    },
                )
                members.append(member)
            if len(group.pairs) and (of := made.of(group)) is not None:
                own = members[-len(group.pairs) :]
                self.root("IfcRelAssociatesMaterial", "", RelatedObjects=own, RelatingMaterial=of)
        return members

    def _join(self, joint: dict[str, Any], beams: Beams | None, row: int, end: int, vertex: Any) -> None:
        """The end of a member at its connection; of a beam with the rotations that are free, and its eccentricity."""
        make, kind = self.file.create_entity, "IfcRelConnectsStructuralMember"
        if beams is not None and beams.releases[row, end]:
            x, _, z = beams.axes[row]
            own = make("IfcAxis2Placement3D", Location=make("IfcCartesianPoint", Coordinates=(0.0, 0.0, 0.0)),
                       Axis=self._direction(z), RefDirection=self._direction(x))  # fmt: skip
            fixed = [True] * 3 + [axis not in beams.releases[row, end] for axis in "xyz"]
            free = make("IfcBoundaryNodeCondition", "release", *(make("IfcBoolean", axis) for axis in fixed))
            joint = {**joint, "AppliedCondition": free, "ConditionCoordinateSystem": own}
        if beams is not None and beams.offsets[row, end].any():
            x, y, z = beams.offsets[row, end].tolist()
            off = make("IfcConnectionPointEccentricity", PointOnRelatingElement=vertex, EccentricityInX=x,
                       EccentricityInY=y, EccentricityInZ=z)  # fmt: skip
            kind, joint = "IfcRelConnectsWithEccentricity", {**joint, "ConnectionConstraint": off}
        self.root(kind, "", **joint)

    def _direction(self, along: Floats) -> Any:
        return self.file.create_entity("IfcDirection", DirectionRatios=tuple(along.tolist()))

    def _actions(self, connections: list[Any]) -> list[Any]:
        actions = []
        numbers = np.concatenate([self.structure.loads, self.structure.moments], axis=1)
        for number in np.flatnonzero((numbers != 0.0).any(axis=1)).tolist():
            load = self.file.create_entity("IfcStructuralLoadSingleForce", "load", *numbers[number].tolist())
            action = self.root("IfcStructuralPointAction", f"load {number}", AppliedLoad=load,
                               GlobalOrLocal="GLOBAL_COORDS", DestabilizingLoad=False)  # fmt: skip
            self.root("IfcRelConnectsStructuralActivity", "", RelatingElement=connections[number],
                      RelatedStructuralActivity=action)  # fmt: skip
            actions.append(action)
        return actions

    def _properties(self, thing: Any, values: dict[str, float]) -> None:
        if not values:
            return
        single = [
            self.file.create_entity("IfcPropertySingleValue", Name=name,
                                    NominalValue=self.file.create_entity("IfcReal", value))
            for name, value in values.items()
        ]  # fmt: skip
        made = self.root("IfcPropertySet", "Hookean_Results", HasProperties=single)
        self.root("IfcRelDefinesByProperties", "", RelatedObjects=[thing], RelatingPropertyDefinition=made)
