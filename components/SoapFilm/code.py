"""A film of constant tension T on a mesh: E = T A, whose equilibria are minimal surfaces.

A is the sum of the triangles' areas; a quad is the mean of its two cuts into triangles, so neither
diagonal is special. The area does not depend on where in the film a vertex lies, so a film has no
stiffness along itself, and its equilibrium is that across it. The part along the film does not
count at vertices on which films act alone, with pressure, or with loads on whole faces; nor, at the
edge of a film that is pulled to a curve, the part along the edge, for sliding there does not change
the film. At vertices of springs and other forces, all of it counts. An unsupported edge draws back:
such a film has no equilibrium. Nor has one between rings too far apart, or under too large a load
on a single vertex; the run then ends as diverged, with its last good shape.

Vertices stay evenly spread, whatever they were when drawn: the solver `auto` fills a rim by one
linear solve, and steps in time and of relaxation pull them along the film, with `evenness` as part
of T. The film's shape does not depend on it but for the error of flat triangles, of the order h^2.

Warp and weft are yarns that run with the material, warp along each face's first edge at the start,
weft across: they pull with a constant force per start width, E = A0 (warp |du| + weft |dv|), |du|
their stretch. (A constant force per present width in two directions has no energy.) Yarns of
constant force cannot balance each other along the film unless both run straight in it, so of them,
too, only what is across the film counts; the cloth bears the rest.

Sources: Pinkall and Polthier, "Computing discrete minimal surfaces and their conjugates", 1993 (the
gradient); Dziuk and Hutchinson, "The discrete Plateau problem", 1999 (the order of the error).

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
