"""Forces, anchors and geometry in motion until they are in equilibrium.

True on _reset reads the setup and holds it at the start, False runs it; False on _on_ pauses it
where it is. While it runs, moved anchors and changed loads, stiffness, rest lengths and settings
act at once; other geometry goes on from the present form. An anchor holds the particle it first
met, wherever it is moved to, also after a reset.

M a = F - drag v until |F| / mean load <= residual
"""

from hookean_client import canvas_engine

found = canvas_engine.solve(ghenv, _forces, anchors_, settings_, geometry_, _reset, _on_)
iterations = found.iterations
particles = found.particles
geometry = found.geometry
forces = found.forces
reactions = found.reactions
residual = found.residual
energy = found.energy
status = found.status
report = found.report
results = found.results
