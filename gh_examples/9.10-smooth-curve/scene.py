"""Figure 9.10: the cable of figure 9.4 in four soft springs, through whose particles a smooth curve is drawn."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.4-cable").scene, pieces=4, stiffness=200.0, load=40.0)
