"""What the equilibrium of a design must be like: a quantity within limits.

The same number as lower and upper makes it equal.

lower <= value <= upper
"""

from hookean_client import canvas_goals

constraints = canvas_goals.constraints(
    ghenv,
    _kind,
    (points_, forces_, anchors_, meshes_),
    axes=axes_,
    elements=elements_,
    column=column_,
    equal=equal_,
    total=total_,
    size=size_,
    name=name_,
    lower=lower_,
    upper=upper_,
)
