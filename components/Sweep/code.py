"""One scene with lists of values, each relaxed to equilibrium: a table of parameters and results.

The service solves the items in the background, several at a time; what is done is shown meanwhile.
Another scene or other values cancel what is under way. Every item starts from the drawn shape, so
its row does not depend on the others. The same sweep is not solved twice within a day.

F(x; p) = 0 for each p of the lists
"""

from hookean_client import canvas_sweep

found = canvas_sweep.sweep(ghenv, _forces, anchors_, settings_, scene_, _parameters, _values, _mode_, results_, _run)
parameters = found.parameters
results = found.results
names = found.names
statuses = found.statuses
table = found.table
progress = found.progress
