"""Tensions between pairs of particles whose component along a vector stays the same: F = H d / |d .
v|.

d is the vector from one to the other, v of length 1 along the given vector, and H the component.
With a horizontal vector, this is a funicular of prescribed horizontal thrust: under loads P its
slopes change by P / H at each particle, as in graphic statics. Hold the particles along the vector
(anchors with `axes`), as the component there does not depend on where they are. The force has no
energy: the tangent is not symmetric, and Newton steps use its symmetric part. A line at a right
angle to the vector (cosine below 1e-6) has no force. Source: classic Kangaroo's ProjectedForce.

F = H d/(d.v)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "projected_force",
    lines=_connection,
    component=_component_,
    direction=_direction_,
    name=name_,
)
