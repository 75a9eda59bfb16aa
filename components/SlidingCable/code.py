"""A cable that slides over saddles, with friction if given: E = EA (L - L0)^2 / (2 L0), L the length
of its lines.

The tension T = EA (L - L0) / L0 is the same in each line, whatever their lengths, so at a free
pulley both lines make the same angle with what the pulley carries. Below L0 the cable is slack.
Lines with the same number are one cable; without numbers all are. Give the stiffness as EA, or as a
material and a section, and the prestress, if any, as the force at the start or as the rest length
of a whole cable. A line of zero length has no direction and no force. For a tension that does not
depend on the length, use `constant_tension`.

With friction mu the forces before and after a saddle, where the cable turns by the angle phi,
differ at most by the factor exp(mu phi). Within it nothing slips and each line is elastic on its
own; at the limit the cable slips. It starts with one force all along. What has slipped stays so for
the next run, and in physical time for the next step. The lines of a cable follow one another in the
order of their rows then. Forces with friction have no energy, and a tangent for Newton steps alone:
the stability of such a model is unknown, and it has no gradients.

Sources: Aufaure, "A finite element of cable passing through a pulley", 1993; Euler, "Remarques sur
l'effet du frottement dans l'equilibre", 1762, and Eytelwein, "Handbuch der Statik fester Koerper",
1808 (friction).

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
    friction=_friction_,
    name=name_,
)
