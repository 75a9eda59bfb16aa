"""Particles pulled to the surface on which the potential of point charges is L: E = k d^2 / 2, d = q
(1 / phi - 1 / L) with phi = sum q_i / r_i.

r_i are the distances of a particle to the charges, which stay where they are, and q is the mean of
these. Of one charge the surface is the sphere of radius q / L, and d is the distance from it.
Several charges give surfaces that merge where these are near each other (Cassini's ovals are alike,
of 1 / r^2); round each of some equal charges that are far apart, d is the distance, too. Between
charges, where phi has no gradient, there is no force. All charges are positive. With other units of
q the surface stays if L has the same. A particle that is exactly on a charge has no direction:
nothing pushes it. Source: Blinn, "A generalization of algebraic surface drawing", 1982; classic
Kangaroo's LevelSet.

E = k q^2 (1/phi - 1/L)^2/2, phi = sigma q/r
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "level_set",
    points=_point,
    charges=_charges,
    charge=_charge_,
    level=_level_,
    strength=_strength_,
    name=name_,
)
