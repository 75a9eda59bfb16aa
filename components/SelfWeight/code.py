"""Weight as loads: `total` / number of particles on each, half of `per_length` x start length on line
ends, or that of a material.

With a total, give particles, points or a mesh (nothing: every particle of the scene): 10 N on 51
particles is 0.196 N each, also where some of the given points met no particle (the scene is not
`strict`) and their part of the total is left out. With a weight per length, give lines, pairs of
particles or a mesh (its edges). A material with a section weighs density x area x gravity per start
length of the same; a cloth, or a solid with a thickness, weighs that on the faces of a mesh, a
third of each triangle's on each of its corners. The load does not change as lines and faces
stretch: weight is conserved. A form that is found may be far longer or larger than it was drawn;
there `line_weight` and `area_weight` weigh what it is. Energy -W d . x. Source: the chapter, 9.5.

E = -W d.x
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "self_weight",
    lines=connection_,
    points=point_,
    per_length=per_length_,
    total=total_,
    direction=_direction_,
    material=material_,
    section=section_,
    thickness=thickness_,
    gravity=gravity_,
    factor=_factor_,
    name=name_,
)
