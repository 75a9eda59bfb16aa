"""Quantities of an equilibrium that goals and constraints name. A new one is a class in a file here, and its place in
QUANTITIES."""

from __future__ import annotations

from hookean.designing.quantities.base import Quantity
from hookean.designing.quantities.buckling import BucklingFactor
from hookean.designing.quantities.curvature import Curvature
from hookean.designing.quantities.direction import Direction
from hookean.designing.quantities.energy import StrainEnergy
from hookean.designing.quantities.faces import Fairness, Planarity
from hookean.designing.quantities.frequency import Frequency
from hookean.designing.quantities.meshes import Area, Volume
from hookean.designing.quantities.of_elements import Force, ForceDensity, Length, LoadPath, Output
from hookean.designing.quantities.offset import Offset
from hookean.designing.quantities.position import Position
from hookean.designing.quantities.reaction import Reaction

QUANTITIES: dict[str, type[Quantity]] = {
    cls.kind_name: cls
    for cls in (
        *(Position, Offset, Length, Force, ForceDensity, LoadPath, Output, StrainEnergy, Reaction, Volume, Area),
        *(Planarity, Fairness, Frequency, BucklingFactor, Curvature, Direction),
    )
}
"""All quantities by kind."""
