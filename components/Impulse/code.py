"""Momentum given to particles at one moment, away from a point, as an explosion does: dv = P u / m.

u is the direction from the origin to the particle at that moment. Each particle gains the momentum
P u, whatever its mass m, at the beginning of the time step that contains the moment, and the
kinetic energy P u . v + P^2 / 2m, v its velocity before. Anchors take what is along their axes. A
negative P pulls towards the origin; a particle at the origin has no direction and gains nothing. An
impulse acts in physical time (`verlet`, `yoshida`, simulations); solvers that look for equilibrium
leave it out and warn. Several moments are several impulses.

deltav = P u/m
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "impulse",
    points=point_,
    origin=_origin_,
    momentum=_momentum_,
    time=_time_,
    name=name_,
)
