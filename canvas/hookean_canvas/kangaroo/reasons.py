"""Why components of Kangaroo have no counterpart, or what to use instead."""

from __future__ import annotations

_PURE = "geometry without mechanics of this kind is not here"
_SOLID = "elements of solids and membranes with a Young's modulus are not here"
_LINE = (
    "forces between lines, or points and lines, by a power of their distance are not here; Collide Lines is a contact"
)
_REASONS = {
    _PURE: "g2 cpmesh reciprocalstructure rheotomicsurface",
    _SOLID: "triangularelement tetrahedralelement",
    _LINE: "lineline pointline",
}
REASONS: dict[str, str] = {
    "soapfilm": "warp and weft are families of a mesh's edges here; connect a mesh to SoapFilm",
    "bomb": "impulses are not here",
    "gstring": "Geodesic Strip takes a mesh and the vertices of its lines",
    "imagecircles": "Circle Image takes an image as numbers",
    "boxcollide": "Box Collide takes the diagonals of all boxes",
    "soft&hardsolver": "goals are not of two ranks here; anchors, locks and floors are exact",
    "livesoap": "meshes do not change their faces while they relax",
    "collidesurf": "connect a mesh to Collide Solid",
    "shear": "a force of this kind is not here",
    "edgebend": "Shell takes a mesh; Hinge takes edges with their tips",
    "origami": "Hinge takes edges with their tips, rest angles and an angle factor",
    "gravity": "Unary takes points and a vector",
    "particle": "masses and first velocities are fields of a scene; the canvas has no component for them",
    "beam": "beams of six degrees of freedom are not here",
    "support": "supports of six degrees of freedom are not here",
    **{name: why for why, names in _REASONS.items() for name in names.split()},
}
"""The reason by the name in lower case without spaces."""
