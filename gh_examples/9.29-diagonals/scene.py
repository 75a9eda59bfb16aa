"""Figure 9.29: the membrane of figure 9.24 in 10 x 10 faces; diagonals keep them from becoming diamonds."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.24-membrane").scene, divisions=10, diagonals="both")
