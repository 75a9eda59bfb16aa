"""Lines that are free between two limits and elastic outside: E = k (l - L)^2 / 2, L the limit that is
passed.

The defaults make a rope: its upper limit is the start length, and it has no lower one, so that it
is slack where its ends come closer. A strut that loses contact has a lower limit alone
(`upper_limit = 0`). A weight P on a rope stretches it to L + P / k. K2's ClampLength has half of
its strength as k.

E = k (l - L)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "clamp_length",
    lines=_connection,
    stiffness=_stiffness_,
    lower_limit=_lower_limit_,
    upper_limit=upper_limit_,
    name=name_,
)
