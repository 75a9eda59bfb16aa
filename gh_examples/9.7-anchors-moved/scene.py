"""Figures 9.7 and 9.8: the cable of figure 9.4, at rest within seconds; its right anchor is moved while it runs."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.4-cable").scene, drag=5.0, tolerance=1e-10)
