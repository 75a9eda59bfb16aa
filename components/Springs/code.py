"""Linear springs (Hooke): tension = k (l - L0), L0 = rest length x rest factor.

Energy k (l - L0)^2 / 2; damping adds c times the rate of stretching along the spring. A spring
works only at lengths up to its upper cutoff and from its lower cutoff on (0: no limit). Plasticity
is the largest elastic deformation as a part of the rest length, yield extension the same as a
length: beyond it the tension stays, and the rest length follows at the end of the step. A rest
length of 0 makes a force-density spring. Source: the chapter, 9.4, figures 9.11 to 9.13.

Cables and bars: give the stiffness in one way, as k, as EA (k = EA / L0 of each element), or as a
material and a section (EA = E x area); a section beside k or EA gives the area for the stress. With
`tension_only` a spring is slack below its rest length, as a cable; with `compression_only` it has
no force above it, as a strut. Give the prestress in one way, too: as the `force` that the spring
has at its start length, the `strain` (l - L0) / L0 there, or the rest length. A rest factor
multiplies the rest length that follows: with the default, 1, the force is as given. A temperature,
of a material with thermal expansion, lengthens the rest length by 1 + expansion x temperature, on
top of the prestress.

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
    axial_stiffness=axial_stiffness_,
    material=material_,
    section=section_,
    strength=strength_,
    force=force_,
    strain=strain_,
    temperature=temperature_,
    tension_only=_tension_only_,
    compression_only=_compression_only_,
    yield_extension=_yield_extension_,
    name=name_,
)
