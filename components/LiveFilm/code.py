"""The soap films on meshes, made again while they relax: triangles of one size.

An open mesh is held along its rim, on the lines drawn; a closed one keeps its volume times a factor.
The mesh as drawn may be coarse.

Area: least, with the rim or the volume as given
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.live_film(ghenv, _mesh, _length, _volume_)
