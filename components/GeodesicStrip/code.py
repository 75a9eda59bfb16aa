"""Lines of a mesh that go straight ahead on it, as geodesics: E = m (sum of angles left - sum right)^2
/ 2.

The lines run along edges. At each of their interior vertices the angles of the faces on one side
sum to the same as on the other: there a line is a straightest geodesic of the mesh, and where the
angles also sum to 2 pi (use `developable`) it is straight once the strip about it is unrolled. On a
sphere such lines are great circles. The ends of a line are free, unless it ends where it began.
Angles of quads are those between their two sides. Forces and moments of each vertex sum to zero.
For strips of the same width, use `equal_length` on their cross edges. Source: Polthier and Schmies,
"Straightest geodesics on polyhedral surfaces", 1998; classic Kangaroo's GString.

E = m (sigmatheta left - sigmatheta right)^2/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "geodesic_strip",
    mesh=_mesh,
    strength=_strength_,
    path=_path,
    name=name_,
)
