"""Why components of Kangaroo have no counterpart, or what to use instead."""

from __future__ import annotations

_PURE = "geometry without mechanics of this kind is not here"
_SOLID = "elements of solids and membranes with a Young's modulus are not here"
_LINE = (
    "forces between lines, or points and lines, by a power of their distance are not here; Collide Lines is a contact"
)
_REASONS = {
    _PURE: "cpmesh reciprocalstructure rheotomicsurface",
    _SOLID: "triangularelement tetrahedralelement",
    _LINE: "lineline pointline",
}
REASONS: dict[str, str] = {
    "soapfilm": "warp and weft are families of a mesh's edges here; connect a mesh to SoapFilm",
    "gstring": "Geodesic Strip takes a mesh and the vertices of its lines",
    "g2": "curves have no elements here whose curvature could be made equal; Smooth and Bend act on polylines",
    "boxcollide": "Box Collide takes the diagonals of all boxes",
    "soft&hardsolver": "goals are not of two ranks here; anchors, locks and floors are exact",
    "livesoap": "Live Film makes the mesh of a film again while it relaxes, without a solver on the canvas",
    "collidesurf": "connect a mesh to Collide Solid",
    "shear": "a force of this kind is not here",
    "edgebend": "Shell takes a mesh; Hinge takes edges with their tips",
    "origami": "Hinge takes edges with their tips, rest angles and an angle factor",
    "gravity": "Unary takes points and a vector",
    "particle": "masses and first velocities are fields of a scene; the canvas has no component for them",
    **{name: why for why, names in _REASONS.items() for name in names.split()},
}
"""The reason by the name in lower case without spaces."""
