# r: compas>=2.4
"""Springs on the edges of a COMPAS Mesh or Graph (Hooke).

A value is one number for all edges, one for each edge in the structure's order, or the name of an
attribute of its edges. A rest factor of 0 makes force densities of the stiffnesses.

tension = k (l - L0), L0 = rest length x rest factor
"""

from hookean_client import compas_canvas

force = compas_canvas.springs(
    ghenv,
    _structure,
    name=name_,
    stiffness=_stiffness_,
    damping=_damping_,
    rest_length=rest_length_,
    rest_factor=_rest_factor_,
)
