"""The corners of each quad of a mesh are pulled onto a circle: E = sum k d^2 / 2, d the distances to
its least-squares circle.

A quad on a circle is flat. The circles move and grow with the corners: forces and moments of each
quad sum to zero, and each corner feels k at most from each of its quads. Triangles of the mesh are
on circles. `co_circular` does this for any groups of particles.

E = sigma k d^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "cyclic_quad",
    mesh=_mesh,
    strength=_strength_,
    name=name_,
)
