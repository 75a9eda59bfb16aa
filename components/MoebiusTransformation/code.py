"""Points moved so that spheres, circles and angles stay what they are.

Stereographic projection to the sphere of four dimensions, a rotation there, and back. The circle of
a radius about the centre, normal to the axis, does not move.

Cross ratios of distances: unchanged
"""

from hookean_client import canvas_points as points

points = points.moebius_transformation(ghenv, _points, _angle, _axis_, _centre_, _radius_)
