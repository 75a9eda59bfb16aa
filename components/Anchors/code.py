"""Points at which particles are held exactly, in some directions or in all.

A moved point takes its particle along. With targets the points select the held particles, and the
targets their positions. A plain point on the engine's anchors_ is an anchor held in all directions.

x = X, reaction = - sum of the forces on the particle
"""

from hookean_client import canvas

anchors = canvas.anchors(ghenv, _point, targets=targets_, x=_x_, y=_y_, z=_z_)
