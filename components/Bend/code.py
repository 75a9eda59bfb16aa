"""Bending of rods and splines at corners a-b-c: moment M = EI / l (phi - phi0).

phi [rad] is the angle by which the segment b-c turns away from a-b, from 0 (straight) to pi, and l
the mean start length of the two segments, so (phi - phi0) / l is the change of curvature. Energy
per corner EI (phi - phi0)^2 / (2 l), phi0 = rest angle x angle factor. This is Hencky's bar chain:
a straight column of n equal segments between pins buckles at (4 n^2 EI / L^2) sin^2(pi / 2n) and
converges with the square of the segments to Euler's elastica.

A rest angle has a side. Corners that share a segment make a rod, in whatever order they are given;
where more than two corners share one, rods end. With tied sections phi and phi0 are vectors along
the axis of the turn, and those at rest travel with the rod: carried along it without twist, as if
its torsional stiffness GJ were infinite. A rod bent against its curvature then costs (phi +
phi0)^2, and it converges to Kirchhoff's rod without twist. What is left is one spin of the whole
rod about its axis. If it is free, the rod takes the spin of least energy: an arch on loose ends
that is turned inside out is the same arch turned over. An end that is one of the scene's anchors
holds its section (a fork bearing), so an arch between anchors snaps through at its cost. Closed
rods, and rods between two anchors, may need to twist; that costs nothing and is even along the rod,
up to half a turn from its start.

With free sections every corner spins by itself (GJ = 0), as in Kangaroo's goals: (|phi| - phi0)^2,
where both sides are the same. The side of a rest angle is that of the start shape; a corner that
starts straight takes that of the one before it on the rod, or else after it. A rod that is straight
all along has no side until something bends it. Sources: Hencky, "Ueber die angenaeherte Loesung von
Stabilitaetsproblemen im Raum", 1920; Wang et al., "Hencky bar-chain/net for structural analysis",
2020; Bergou et al., "Discrete elastic rods", 2008.

E = EI |phi - phi0|^2/(2 l)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "bend",
    points=(_point_1, _point_2, _point_3),
    stiffness=_stiffness_,
    rest_angle=rest_angle_,
    angle_factor=_angle_factor_,
    sections=_sections_,
    name=name_,
)
