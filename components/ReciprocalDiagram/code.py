"""The reciprocal figure of flat meshes: forces that balance at inner vertices.

Each inner edge becomes a line at a right angle to it, force density times its length long; those of
an inner vertex close to a polygon. Force densities are the nearest to 1 that balance.

Line: q l long, normal to its edge
"""

from hookean_client import canvas_quads as quads

lines, densities = quads.reciprocal_diagram(ghenv, _mesh)
