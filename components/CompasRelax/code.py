# r: compas>=2.4
"""COMPAS structures in equilibrium under forces.

What comes out are copies: edges have the attributes force [force] (tension +), length [length] and
strain [-], vertices or nodes reaction [force]. It is solved on the server, the canvas stays free.

sum of forces = 0 on every free vertex
"""

from hookean_client import compas_canvas

found = compas_canvas.relax(ghenv, _structures, _forces, anchors_, settings_)
structures = found.structures
geometry = found.geometry
status = found.status
residual = found.residual
report = found.report
