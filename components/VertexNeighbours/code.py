"""The neighbours of the vertices of meshes in their order round the normal, and the normals.

Neighbours are joined to the vertex by an edge; they run counter-clockwise about the normal, at a
boundary from its one edge to the other. Normals are those of the sum of the vector areas of the
faces at the vertex.

A branch of neighbours for each vertex
"""

from hookean_client import canvas_meshes as meshes

points, neighbours, indices, normals = meshes.vertex_neighbours(ghenv, _mesh, vertices_)
