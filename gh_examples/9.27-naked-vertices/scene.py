"""Figure 9.27: the membrane of figure 9.24 held along its rim, or at corners and points inside."""

from functools import partial

from hookean.commands.examples import figure

POINTS = [(x, y, 0.0) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10), (3, 3), (7, 3), (7, 7), (3, 7))]  # m, `anchors`

scene = partial(figure("9.24-membrane").scene, held="rim")
