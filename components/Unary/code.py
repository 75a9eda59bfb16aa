"""A load: a constant force vector F on each particle. Energy -F . x. Source: the chapter, 9.3.

E = -F.x
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "unary",
    points=_point,
    vector=_force,
    name=name_,
)
