"""Quantities of an equilibrium that goals and constraints name. A new one is a class in a file here, and its place in
QUANTITIES."""

from __future__ import annotations

from hookean.designing.quantities.base import Quantity
from hookean.designing.quantities.meshes import Area, Volume
from hookean.designing.quantities.of_elements import Force, ForceDensity, Length, LoadPath, Output
from hookean.designing.quantities.position import Position
from hookean.designing.quantities.reaction import Reaction

QUANTITIES: dict[str, type[Quantity]] = {
    cls.kind_name: cls for cls in (Position, Length, Force, ForceDensity, LoadPath, Output, Reaction, Volume, Area)
}
"""All quantities by kind."""
