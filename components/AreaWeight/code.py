"""A load q per area of the faces of a mesh, in one direction: f = q A g / 3 on each corner.

g is the direction of the load, gravity unless given. A is the true area of a face as it is now: the
load grows with the faces, as that of a form-found shell of constant thickness, of whose final area
nothing is known yet. Per plan A is the area of the shadow of the face along g, as codes give snow;
faces that lie above one another each carry it. Per start A stays that of the start, as the weight
of a membrane that stretches. For a load along the normals use `pressure`. A quad is the mean of its
two cuts into triangles.

Per true and plan area these forces have no energy: moving a face up large and down small gains
work; what is reported is -F . x of the present load F. Newton steps use the symmetric part of their
stiffness.

f = q A g/3
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "area_weight",
    mesh=_mesh,
    per=_per_,
    weight=_weight_,
    direction=_direction_,
    name=name_,
)
