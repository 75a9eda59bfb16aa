"""Bending of rods and splines at corners a-b-c: moment M = EI / l (phi - phi0).

phi [rad] is the angle by which the segment b-c turns away from a-b, from 0 (straight) to pi, and l
the mean start length of the two segments, so (phi - phi0) / l is the change of curvature. Energy
per corner EI (phi - phi0)^2 / (2 l), phi0 = rest angle x angle factor. This is Hencky's bar chain:
a straight column of n equal segments between pins buckles at (4 n^2 EI / L^2) sin^2(pi / 2n) and
converges with the square of the segments to Euler's elastica. The angle has no sign in space: any
plane of bending is as stiff, there is no torsion, and a corner that is exactly straight but has a
rest angle stays straight until something bends it. Source: Hencky, "Ueber die angenaeherte Loesung
von Stabilitaetsproblemen im Raum", 1920; Wang et al., "Hencky bar-chain/net for structural
analysis", 2020.

E = EI (phi - phi0)^2/(2 l)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "bend",
    points=(_point_1, _point_2, _point_3),
    stiffness=_stiffness_,
    rest_angle=rest_angle_,
    angle_factor=_angle_factor_,
    name=name_,
)
