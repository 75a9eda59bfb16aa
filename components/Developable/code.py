"""Angles round each interior vertex of a mesh sum to 2 pi, as in a sheet: E = m (sum theta - 2 pi)^2 /
2.

A mesh of flat faces with this property at all interior vertices unrolls into the plane. theta are
the angles of the faces at the vertex, those of quads between their two sides (use `planarize` for
quads that are not flat). Forces and moments of each vertex sum to zero. A vertex with a side of
zero length counts without the angles there.

E = m (sigmatheta - 2pi)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "developable",
    mesh=_mesh,
    strength=_strength_,
    name=name_,
)
