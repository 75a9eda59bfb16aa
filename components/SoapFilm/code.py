"""A film of constant tension T on a mesh: E = T A, whose equilibria are minimal surfaces.

A is the sum of the triangles' areas; a quad is the mean of its two cuts into triangles, so neither
diagonal is special. The area does not tell where within the film a vertex lies, and the vertices of
an area alone slide until triangles fold over. So every triangle has the small part s of its energy
from D instead of A, E = T ((1 - s) A + s D), where D = sum(cot(a0) l^2) / 4 >= A, with equality
where the triangle is similar to its start shape (angles a0, opposite edges l). s = evenness x start
area / start area of the whole film, at most 1/2: it vanishes like h^2 as the mesh gets finer, like
the error of flat triangles. Evenness 0 is the area alone.

Warp and weft are yarns that run with the material, warp along each face's first edge at the start,
weft across: they pull with a constant force per start width, E = A0 (warp |du| + weft |dv|), |du|
their stretch. (A constant force per present width in two directions has no energy.) A film that has
no equilibrium, such as between rings too far apart, collapses, and the run says so. The mesh's
faces without area at the start are left out.

Sources: Pinkall and Polthier, "Computing discrete minimal surfaces and their conjugates", 1993 (A,
D and their gradients); Bletzinger and Ramm, "A general finite element approach to the form finding
of tensile structures by the updated reference strategy", 1999 (the mixture).

E = T A
"""

from hookean_client import canvas

force = canvas.force(
    ghenv,
    "soapfilm",
    mesh=_mesh,
    tension=_tension_,
    warp=_warp_,
    weft=_weft_,
    evenness=_evenness_,
    name=name_,
)
