"""Linear springs (Hooke): tension = k (l - L0), L0 = rest length x rest factor.

Energy k (l - L0)^2 / 2; damping adds c times the rate of stretching along the spring. A spring
works only at lengths up to its upper cutoff and from its lower cutoff on (0: no limit). Plasticity
is the largest elastic deformation as a part of the rest length, yield extension the same as a
length: beyond it the tension stays, and the rest length follows at the end of the step. A rest
length of 0 makes a force-density spring. Source: the chapter, 9.4, figures 9.11 to 9.13.

E = k (l - L0)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "springs",
    lines=_connection,
    stiffness=_stiffness_,
    damping=_damping_,
    rest_length=rest_length_,
    upper_cutoff=_upper_cutoff_,
    lower_cutoff=_lower_cutoff_,
    plasticity=_plasticity_,
    rest_factor=_rest_factor_,
    edges=_edges_,
    yield_extension=_yield_extension_,
    name=name_,
)
