"""Figures 9.14 and 9.15: a chain of 12 m and 1 N/m that hangs on y = a cosh(x / a), over the axes of the graph."""

from functools import partial

from hookean.commands.examples import figure
from hookean.discretize.catenary import catenary_of, parameter

SPAN, LENGTH = 10.0, 12.0  # m
TOP = float(catenary_of(parameter(SPAN, LENGTH), 0.5 * SPAN))

scene = partial(
    figure("9.16-catenary-component").scene,
    start=(-0.5 * SPAN, 0.0, TOP), end=(0.5 * SPAN, 0.0, TOP), length=LENGTH, links=120,
)  # fmt: skip
