"""Hinges that push back where they fold beyond a limit: E = S (|theta| - limit)^2 / 2, nothing below
it.

theta is the fold angle between the triangles start-end-tip 1 and end-start-tip 2, 0 where flat, as
for `hinge`. At the limit of pi, the default, the triangles lie on each other. At the end of each
step theta is remembered, so that it is counted on beyond pi instead of being that of a fold to the
other side. Forces and moments of every hinge sum to zero. Edges of a mesh count where two triangles
share them; its quads are left out.

E = S (|theta| - limit)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "no_fold_through",
    points=(_point_1, _point_2, _point_3, _point_4),
    mesh=_mesh,
    strength=_strength_,
    limit=_limit_,
    name=name_,
)
