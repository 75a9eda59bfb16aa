"""Figure 9.11: the cable of figure 9.4 in five springs; those nearer the supports stretch more."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.4-cable").scene, pieces=5, load=20.0)
