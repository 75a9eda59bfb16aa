"""A fixed amount of gas in a closed mesh, at constant temperature: p = p0 V0 / V - p_out (Boyle's
law).

Energy -p0 V0 ln(V / V0) + p_out V. p0 is the absolute pressure in the volume V0 at the start, p_out
that around the mesh, 0 for none. Each corner of a triangle takes p A n / 3. Faces are oriented
outwards; forces and moments sum to zero. Below a thousandth of V0 the gas stays as stiff as there.
Meshes of more than 300 particles have no tangent: such models relax, and their stability is
unknown.

E = -p0 V0 ln(V/V0) + p_out V
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "gas",
    mesh=_mesh,
    pressure=_pressure_,
    outside=_outside_,
    name=name_,
)
