"""Elastic cloth on a mesh, woven of warp and weft: E = A0 W(strain), at any displacement.

W is the energy per start area of the Green strain along warp and weft, e C e / 2 (St. Venant-
Kirchhoff), with C^-1 = [[1/Ew, -nu/Ew, 0], [-nu/Ew, 1/Ef, 0], [0, 0, 1/G]]: stiffnesses are per
width [force/length], and nu is how much the cloth contracts along the weft where the warp is
pulled. A sheet of modulus E and thickness t has Ew = E t. Strain is constant in each triangle, and
a quad is the mean of its two cuts. The start shape, or another `shape`, has the `prestress` along
warp, weft and in shear, and is free of strain without one. A `temperature` makes it larger by g = 1
+ expansion x temperature: the strain e less (g^2 - 1) / 2 along warp and weft counts.

The warp runs along a vector that is projected on each triangle; along the nearest of some lines;
or, without either, along the rows of the mesh, from the first edge of its first face, which needs
quads (or cloth that is alike in all directions).

With `wrinkling` the cloth has no compression: it buckles into fine wrinkles, or goes slack, at no
cost. Its energy is then the least of W(e + a) over shortenings a that wrinkles can take up (the
relaxed energy of tension-field theory), so that forces are its gradient. Slack cloth has no
stiffness; where nothing else holds a particle, its place is not determined.

A result reports the stress per width as it is: along the present warp, across it, shear, the
largest and the least, and the state of each triangle: 2 taut, 1 wrinkled, 0 slack. Sources: Pipkin,
"Relaxed energy densities for large deformations of membranes", 1994; Steigmann, "Tension-field
theory", 1990.

E = A0 e.C.e/2
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "membrane",
    mesh=_mesh,
    material=material_,
    thickness=thickness_,
    warp_stiffness=warp_stiffness_,
    weft_stiffness=weft_stiffness_,
    shear_stiffness=shear_stiffness_,
    poisson=poisson_,
    warp=warp_,
    warp_lines=warp_lines_,
    prestress=_prestress_,
    temperature=temperature_,
    shape=shape_,
    wrinkling=_wrinkling_,
    name=name_,
)
