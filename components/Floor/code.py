"""A plane no particle passes: rebound with `restitution`, dry (Coulomb) friction.

A particle that hits with normal speed u leaves with e u, so a ball dropped from h rises to h e^2;
one that rests is carried with N >= 0 and held sideways up to mu_s N, and slides against mu_k N,
with mu_k <= mu_s. Classic Kangaroo's friction numbers have no published formula; the friction
coefficients here are ours.

N >= 0, |T| <= mu N
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "floor",
    point=_point_,
    normal=_normal_,
    restitution=_restitution_,
    static_friction=_static_friction_,
    kinetic_friction=_kinetic_friction_,
    name=name_,
)
