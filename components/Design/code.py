"""The values of variables for which the equilibrium of forces and anchors meets goals and constraints.

The service searches in the background. If a slider moves, the search goes on from the last
values, so the optimum follows. scene has the values found: connect it to Sweep, or save it.

min sum w (g(x(u)) - target)^2 with F(x; u) = 0, lower <= u <= upper
"""

from hookean_client import canvas_design

found = canvas_design.design(
    ghenv, _forces, anchors_, settings_, geometry_, _variables, _goals, constraints_, _method_, _run_
)
values = found.values
names = found.names
goals = found.goals
constraints = found.constraints
objective = found.objective
geometry = found.geometry
particles = found.particles
forces = found.forces
reactions = found.reactions
status = found.status
scene = found.scene
report = found.report
