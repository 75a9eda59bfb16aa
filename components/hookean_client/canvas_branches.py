"""Results of several items in the branches of Grasshopper's trees. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words


def column(ghenv, values):
    """Values of several items as an output; see `each`."""
    if not values or not isinstance(values[0], list):
        return values
    return values[0] if len(values) == 1 else below(ghenv, values)


def below(ghenv, rows):
    """A tree with a branch for each row, below the branch that this run is about."""
    above = path(ghenv).strip("{}")
    return geometry.to_tree([("{%s;%d}" % (above, i), row) for i, row in enumerate(rows)])


def path(ghenv):
    """The path, as text, of the branch that this run of a component is about."""
    run, found = words.run_of(ghenv), []
    for parameter in ghenv.Component.Params.Input:
        paths = list(getattr(parameter.VolatileData, "Paths", None) or [])
        found = paths if len(paths) > len(found) else found
    return str(found[run - 1]) if run <= len(found) else "{%d}" % (run - 1)
