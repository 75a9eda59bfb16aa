"""What the equilibrium of a design should be like: a quantity and its target.

Without a target the quantity is minimised. Points, forces, anchors and meshes that are connected
have a goal each; points have one together.

sum of weight (value - target)^2, or of weight x value without a target
"""

from hookean_client import canvas_goals

goals = canvas_goals.goals(
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
    target=target_,
    lower=lower_,
    upper=upper_,
    weight=_weight_,
)
