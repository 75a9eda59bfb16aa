"""Vertices of a mesh are pulled to the weighted mean of their neighbours: E = k |p - sum w_j p_j|^2 /
2.

The weights sum to 1 and are those of the start shape, so the force is linear: -k r on the vertex
and k w_j r on its neighbours, r = p - sum w_j p_j. Forces and moments sum to zero. Uniform weights
are those of K2's Smooth, which has half of its strength as k: they also make edges equally long.
Cotangent weights (of a quad the mean of both cuts) are those of Laplace's equation on the mesh: no
vertex of a flat mesh moves within its plane. With inverse lengths near neighbours count more
(Fujiwara). A vertex whose weights have no positive sum gets uniform ones. Interior vertices have a
force of their own; the others only as neighbours, unless all are asked for.

E = k |p - sigma w p_j|^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "smooth",
    mesh=_mesh,
    stiffness=_stiffness_,
    weights=_weights_,
    vertices=_vertices_,
    name=name_,
)
