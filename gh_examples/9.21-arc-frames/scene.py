"""Figure 9.21: the arc of figure 9.18 on its way down to the catenary, a frame every 0.2 s."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.17-arc-to-catenary").scene, time_step=0.0025, sub_iterations=80, drag=1.0)
