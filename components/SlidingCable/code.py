"""A cable that slides over saddles without friction: E = EA (L - L0)^2 / (2 L0), L the length of all
its lines.

The tension T = EA (L - L0) / L0 is the same in each line, whatever their lengths, so at a free
pulley both lines make the same angle with what the pulley carries. Below L0 the cable is slack.
Lines with the same number are one cable; without numbers all are. Give the stiffness as EA, or as a
material and a section, and the prestress, if any, as the force at the start or as the rest length
of a whole cable. A line of zero length has no direction and no force. For a tension that does not
depend on the length, use `constant_tension`. Source: Aufaure, "A finite element of cable passing
through a pulley", 1993.

E = EA (L - L0)^2/(2 L0)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "sliding_cable",
    lines=_connection,
    group=group_,
    axial_stiffness=_axial_stiffness_,
    material=material_,
    section=section_,
    rest_length=rest_length_,
    force=force_,
    name=name_,
)
