"""Lines that are pulled to the nearest multiple of a length a: E = k (l - n a)^2 / 2, n a whole
number.

n is found again wherever the line is, so that each multiple has a well of its own, from (n - 1/2) a
to (n + 1/2) a: a load P below k a / 2 moves the line by P / k within its well, and a larger one
moves it to the next. Lines shorter than a / 2 are pulled to zero length (n = 0). K2's LengthSnap
has the same strength.

E = k (l - n a)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "length_snap",
    lines=_connection,
    stiffness=_stiffness_,
    multiple=_multiple_,
    name=name_,
)
