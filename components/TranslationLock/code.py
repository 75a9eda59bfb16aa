"""Pairs of particles a, b that keep the vector t between them: E = k |b - a - t|^2 / 2.

By default t is the vector of the start. The pair may move, and may not turn: forces sum to zero,
moments do not. Pairs with the same vector keep two edges alike, such as those that meet in a
periodic pattern.

E = k |b - a - t|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "translation_lock",
    lines=_connection,
    stiffness=_stiffness_,
    translation=translation_,
    name=name_,
)
