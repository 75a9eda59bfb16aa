"""Particles pulled to the closest point C of a NURBS surface that itself stays where it is: E = S |C -
x|^2 / 2.

The surface is exact: spheres, cylinders and tori are what they are, not a mesh, and nothing holds a
particle back along it. It is given by its degrees, rows of control points, knots and weights; in
Python `on` makes the force from a rhino3dm surface, an untrimmed face or a
`discretize.NurbsSurface`. Knots are those of the textbook or Rhino's, without the first and the
last. Trims do not count. The search starts at the nearest cell of a mesh of the surface and goes
downhill by Newton's method, over creases and closed seams, to an edge at most; where two points are
nearly as close, it may find the other one. A particle rests at a distance load / S from the
surface; a strength of 0 has no effect (it is not a hard constraint). Source: Piegl and Tiller, The
NURBS Book, 1997, chapters 2, 4 and 6.1 (evaluation, point projection).

E = S |C - x|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "pull_to_surface",
    control_points=_surface,
    points=_point,
    strength=_strength_,
    name=name_,
)
