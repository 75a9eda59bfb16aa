"""Figure 9.9: the cable of figure 9.4 with a third anchor. Between particles, at (4.5, 0, 0), it is an error where
`strict`."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.4-cable").scene, anchors=((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (10.0, 0.0, 0.0)))
