"""A smooth curve through points, to look at.

It is not the physical shape: springs are straight between their particles, and particles are
hinges. The curve passes all points; those in one place are passed once.

Spline of degree d over the lengths of the chords
"""

from hookean_client import canvas_curves as curves

curve = curves.interpolate(ghenv, _points, _count_, _degree_)
