"""The paths of points over the solutions of the canvas, such as particles of an Engine.

Each solution adds the places of the points that have moved. Another number of points begins again.

Path: the places of a point, in the order of the solutions
"""

from hookean_client import canvas_drivers as drivers

trail, points = drivers.trail(ghenv, _points, _reset_, _record_)
