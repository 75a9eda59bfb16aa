"""Beams between two particles with orientations: E = EA u^2/(2L) + (bending) + GJ phi^2/(2L).

Each particle at the end of a beam has an orientation, and takes moments; beams that share one are
rigidly joined. A beam may move and turn as far as it likes; its strains, seen from its chord, are
small: u is the change of the chord's length and of what bending shortens it by, L (2 a^2 - a b + 2
b^2) / 30 for the angles a, b [rad] of its ends to the chord, phi the twist [rad]. Bending about
each axis has the energy EI/(2L) (4 a^2 + 4 a b + 4 b^2), the cubic of Euler and Bernoulli; with
shear areas, that of Timoshenko. What a section feels: N (tension +) and Mt, which are even along a
beam, My and Mz at its start (0) and end (1), and the shear forces Vz = (My1 - My0) / l, Vy = (Mz0 -
Mz1) / l, as what lies behind a section acts on what lies before it, in the section's axes.

Give E, G, A, Iy, Iz and J, or the names of a material and a section of the scene. With a
`temperature` L is the drawn length times 1 + expansion x temperature; the section stays. Loads act
on particles: a `line_weight` or `self_weight` W along a beam bends it by nothing between its ends,
where W l / 8 is missing; divide beams under such loads into several (a warning reports where much
is missing).

The section's axis x runs along the beam, z is in the plane of x and `normal`, and y = z cross x.
Rows that are straight without stress are bent in, and twisted in where the normals turn along the
row. A hinge about one axis, or about all, may turn as far as it likes. Turns of particles whose
beams are all hinged move nothing, and count as no mechanism. In motion a particle has an isotropic
inertia, that of a rod of its mass and of the mean length of the beams there. Sources: Oran,
"Tangent stiffness in space frames", 1973 (angles to the chord, and shortening); Bergou et al.,
"Discrete elastic rods", 2008 (twist); Przemieniecki, Theory of matrix structural analysis, 1968,
5.6 (shear).

E = EA u^2/(2L) + EI (4a^2+4ab+4b^2)/(2L) + GJ phi^2/(2L)
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "beam",
    lines=_connection,
    E=e_,
    G=g_,
    A=a_,
    Iy=iy_,
    Iz=iz_,
    J=j_,
    material=material_,
    section=section_,
    temperature=temperature_,
    shear_y=_shear_y_,
    shear_z=_shear_z_,
    normal=normal_,
    offset_start=_offset_start_,
    offset_end=_offset_end_,
    release_start=release_start_,
    release_end=release_end_,
    curvature=_curvature_,
    name=name_,
)
