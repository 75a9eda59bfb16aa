"""Bending of a mesh as a thin plate or shell of bending stiffness D, from the fold angles of its
edges.

Energy per triangle A D ((1 - nu) |K|^2 + nu (tr K)^2) / 2, A its start area and K [1/length] its
change of curvature, nu Poisson's ratio; a sheet of thickness t and modulus E has D = E t^3 / (12 (1
- nu^2)), so bending to the curvature k in one direction costs D k^2 / 2 per area. Give D, or a
material and a thickness; with `membrane` on the same mesh it is a whole shell.

K = sum over the three edges of (2 / h) phi n n^T, h the height on the edge, n its normal in the
plane of the triangle, phi the part of the edge's change of fold angle theta - theta0 that lies on
this side of the edge (the other triangle has the rest; Morley's plate element). phi is h / (h + h')
(theta - theta0), corrected by the folds of the neighbouring edges as constant curvature of the
start mesh requires. So constant curvature has its exact energy and its moments balance on any mesh,
sheared or irregular. Naked edges turn freely (K has the least energy), so an edge that is held is
simply supported; to clamp it, hold a second row of vertices as well, half a mesh width inside and
half outside of the clamp. theta0 = angle factor x start angle. Quads are split along their shorter
diagonal (a draw: first to third corner), which folds as any edge. Forces and moments of every
triangle sum to zero, whatever its size.

A result reports the largest fold of each triangle's edges, and the larger of its two principal
bending moments per width, without its sign; with a thickness also the stress of bending at its
faces, 6 M / t^2.

The mesh may not have three faces at one edge; faces without area are left out. Sources: Morley,
"The constant- moment plate-bending element", 1971; Grinspun et al., "Discrete shells", 2003;
Grinspun et al., "Computing discrete shape operators on general meshes", 2006.

E = A D ((1 - nu) |K - K0|^2 + nu tr^2(K - K0))/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "shell",
    mesh=_mesh,
    strength=_strength_,
    angle_factor=_angle_factor_,
    poisson=poisson_,
    material=material_,
    thickness=thickness_,
    name=name_,
)
