"""The form of forces and anchors, frozen to an elastic model, under load cases and combinations.

The service finds the form without the loads of cases, takes elastic elements that are at rest in
it, and solves each case from there, side by side. Lines of constant tension and springs of rest
length 0 need an axial stiffness in stages.

L0 = l EA / (EA + T), then F(x) = 0 for each case
"""

from hookean_client import canvas_cases

found = canvas_cases.cases(
    ghenv, _forces, anchors_, settings_, geometry_, _cases, combinations_, stages_, chosen_, _run_
)
names = found.names
statuses = found.statuses
form = found.form
particles = found.particles
displacements = found.displacements
forces = found.forces
utilisation = found.utilisation
reactions = found.reactions
slack = found.slack
extremes = found.extremes
largest = found.largest
largest_cases = found.largest_cases
smallest = found.smallest
scene = found.scene
report = found.report
