"""Opposite angles at each vertex with four faces have the same sum: E = m (t1 - t2 + t3 - t4)^2 / 2.

t1 to t4 are the angles of the faces round an interior vertex. Where the faces are flat (use
`planarize`) they then touch a cone of revolution, and the mesh has offsets at a constant distance,
and beams whose axes meet in nodes without torsion. Vertices with another number of faces have no
such force. Forces and moments of each vertex sum to zero. Source: Wang, Wallner and Liu, "An angle
criterion for conical mesh vertices", 2007.

E = m (theta1 - theta2 + theta3 - theta4)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "conical",
    mesh=_mesh,
    strength=_strength_,
    name=name_,
)
