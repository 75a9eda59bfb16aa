"""Components that make a mesh of a surface, or read meshes. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_branches import column, path
from .canvas_discretize import answers, each
from .canvas_geometry import listed, missing
from .canvas_values import default, whole, word


def mesh_surface(ghenv, surfaces, u, v):
    """Each surface as a mesh of u by v quads."""
    sizes = {"u": u, "v": v}

    def work():
        for name in sizes:
            sizes[name] = whole(sizes[name], 10, name)
        return each(ghenv, "mesh_surface", surfaces, ["mesh"], **sizes)[0]

    return words.told(ghenv, work)


def mesh_edges(ghenv, meshes):
    """All edges of each mesh, and those at its boundary."""
    return each(ghenv, "edges", meshes, ["lines"]) + each(ghenv, "naked_edges", meshes, ["lines"])


def mesh_vertices(ghenv, meshes):
    """The vertices of each mesh; no service is asked."""

    def work():
        given = listed(meshes)
        if not given:
            raise missing("mesh is missing; connect it")
        return column(ghenv, [[geometry.to_point(one) for one in geometry.mesh(mesh)["vertices"]] for mesh in given])

    return words.told(ghenv, work)


def mesh_corners(ghenv, meshes, angles, order):
    """Boundary vertices whose angle inside the mesh is below a number [rad], and their numbers."""

    def work():
        options = {"angle": default(angles, 2.356194490192345), "order": word(order, ("index", "boundary"), "order")}
        return each(ghenv, "corners", meshes, ["points", "indices"], **options)

    return words.told(ghenv, work) or (None, None)


def naked_vertices(ghenv, meshes):
    """Numbers of the clothed and of the naked vertices, and where they are."""
    return each(ghenv, "boundary", meshes, ["clothed", "naked", "clothed_points", "naked_points"])


def vertex_neighbours(ghenv, meshes, vertices):
    """The vertices asked for, a branch of neighbours and of their numbers for each, and the normals."""

    def work():
        wanted = [int(geometry.number(one)) for one in listed(vertices)]
        found = answers(ghenv, "vertex_neighbours", meshes, vertices=[wanted] if wanted else None)
        if found is None:
            return None
        places, rings, numbers, above = [], [], [], path(ghenv).strip("{}")
        for i, (one, mesh) in enumerate(zip(found, listed(meshes))):
            corners = [geometry.to_point(place) for place in geometry.mesh(mesh)["vertices"]]
            places.append([corners[v] for v in wanted or range(len(corners))])
            branch = "{%s;%%d}" % (above if len(found) == 1 else "%s;%d" % (above, i))
            rings += [(branch % j, [corners[v] for v in ring]) for j, ring in enumerate(one["neighbours"])]
            numbers += [(branch % j, ring) for j, ring in enumerate(one["neighbours"])]
        normals = column(ghenv, [one["normals"] for one in found])
        return column(ghenv, places), geometry.to_tree(rings), geometry.to_tree(numbers), normals

    return words.told(ghenv, work) or [None] * 4
