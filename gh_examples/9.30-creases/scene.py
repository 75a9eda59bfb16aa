"""Figure 9.30: the membrane of figure 9.24 as a sheet of edges and diagonals; shorter diagonals fold its faces."""

from functools import partial

from hookean.commands.examples import figure

scene = partial(figure("9.24-membrane").scene, diagonals="both", diagonal_stiffness=2000.0, load=1.0)
