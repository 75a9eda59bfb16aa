"""Figure 9.6: the cable of figure 9.4 in motion, frames of 50 steps of 1 ms."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(
    figure("9.4-cable").scene, solver="verlet", time_step=0.001, sub_iterations=50, drag=1.0, tolerance=1e-10
)
