"""The edges of meshes as lines, each once, in order of first appearance round the faces.

Several meshes in one branch give a branch each. Vertices in one place that are not welded have
edges of their own.

Edges of a closed mesh without holes of V vertices and F faces: V + F - 2
"""

from hookean_client import canvas_meshes as meshes

edges, naked = meshes.mesh_edges(ghenv, _mesh)
