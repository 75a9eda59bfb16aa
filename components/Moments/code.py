"""Shapes of a motion at given moments, all of them at once.

The motion runs in physical time from what is drawn, on the server, with the time step, drag and
solver of Settings; a moment is taken to the nearest whole step. The Engine shows the same motion
as it goes; here stand the positions that it passes through, side by side.

shape(t), t = number of steps x time step
"""

from hookean_client import canvas_moments

found = canvas_moments.moments(ghenv, _forces, anchors_, settings_, geometry_, _times)
geometry = found.geometry
particles = found.particles
times = found.times
report = found.report
