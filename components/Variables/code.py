"""What may vary in a design problem: a column of a force, where anchors hold their particles, or particles themselves.

A column is a field of a force component, such as stiffness, rest_length, tension or vector. With
tie all there is one value for all elements, else each has its own; an anchor moves as a whole.
With the field drawn, points are where particles are drawn, from which rest lengths are measured;
with the field mass, their masses vary.

lower <= u <= upper
"""

from hookean_client import canvas_goals

variables = canvas_goals.variables(ghenv, _force, _field, anchors_, _axes_, _tie_, lower_, upper_, name_)
