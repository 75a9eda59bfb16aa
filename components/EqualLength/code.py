"""Groups of lines that become equally long: E = sum k (l - m)^2 / 2, m the mean length of the group.

m is weighted by k, so that the energy is least by it, and the tension of each line is k (l - m): it
sums to zero over the group, which neither grows nor shrinks. Lines with the same number are one
group; without numbers all are. A line of zero length has no direction and no force. K2's
EqualLength has half of its strength as k.

E = sigma k (l - m)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "equal_length",
    lines=_connection,
    group=group_,
    stiffness=_stiffness_,
    name=name_,
)
