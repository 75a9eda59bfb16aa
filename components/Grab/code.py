"""Particles of an Engine can be dragged by the mouse in Rhino's viewports while it runs.

Connect it to the forces of the Engine. Press the left button near a particle and drag: it follows
the mouse, across the line of sight, and is free again when you let go. With a strength it is pulled
by a spring. Particles that anchors hold stay.

F = S (mouse - x)
"""

from hookean_client import canvas_grab as hand

grab = hand.grab(ghenv, _on_, _range_, _strength_)
