"""Figure 9.26: the membrane of figure 9.24, stretched; its corners are led up and down while it runs."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.24-membrane").scene, rest_factor=0.8, drag=5.0, tolerance=1e-10)
