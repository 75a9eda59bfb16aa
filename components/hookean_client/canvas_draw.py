"""What the engine draws into Rhino's views: springs coloured by their force, with a legend, and unmatched points.

Only where Rhino can draw; for Python 2.7 to 3.13.
"""

COLD = ((6, 48, 110), (31, 102, 176), (94, 162, 214), (169, 201, 226))
WARM = ((243, 181, 142), (226, 122, 76), (194, 53, 43), (111, 10, 30))
MIDDLE, MISSED = (211, 211, 211), (142, 68, 173)
STEPS = 5  # lines of the legend
_displays = {}  # by session


def draw(ghenv, player):
    """Draw how it stands now in the place of what was drawn before; nothing where the preview is off."""
    display = _display(player.key)
    if display is None:
        return
    display.Clear()
    component = ghenv.Component
    display.Enabled = not (getattr(component, "Hidden", False) or getattr(component, "Locked", False))
    if not display.Enabled:
        return
    from . import canvas_geometry as geometry

    frame, topology = player.frame(), player.topology
    flat, pulls = frame["particles"], frame["scalars"]
    scale = ramp(pulls)
    if len(pulls) == len(topology["springs"]):
        for (a, b), pull in zip(topology["springs"], pulls):
            line = geometry.to_line([flat[3 * a : 3 * a + 3], flat[3 * b : 3 * b + 3]])
            display.AddLine(line, _colour(scale(pull)), 2)
        _legend(display, flat, pulls, scale, topology["units"]["force"])
    for one in player.state["report"]["unmatched"]:
        _mark(display, one["point"])


def clear(key):
    """Take away what is drawn for a session."""
    display = _displays.pop(key, None)
    if display is not None:
        display.Enabled = False
        display.Dispose()


def ramp(pulls):
    """A function from a force to red, green and blue: blue compression, red tension, grey between where both occur."""
    low, high = (min(pulls), max(pulls)) if len(pulls) else (0.0, 0.0)
    largest = max(abs(low), abs(high))
    if low < -1e-9 * largest and high > 1e-9 * largest:
        colours, low, high = COLD + (MIDDLE,) + WARM, -largest, largest
    elif high <= 1e-9 * largest and largest > 0.0:
        colours = COLD
    else:
        colours = WARM
    if not high > low:
        low, high = low - max(abs(low), 1.0) * 1e-3, high + max(abs(high), 1.0) * 1e-3

    def colour(pull):
        at = min(max((pull - low) / (high - low), 0.0), 1.0) * (len(colours) - 1)
        i = min(int(at), len(colours) - 2)
        return tuple(round(a + (at - i) * (b - a)) for a, b in zip(colours[i], colours[i + 1]))

    colour.low, colour.high = low, high
    return colour


def _legend(display, flat, pulls, scale, unit):
    """Forces with their colours in lines of text beside the form."""
    if not len(pulls):
        return
    import Rhino

    lows = [min(flat[i::3]) for i in range(3)]
    highs = [max(flat[i::3]) for i in range(3)]
    size = max(high - low for low, high in zip(lows, highs)) / 30.0 or 1.0
    low, high = min(pulls), max(pulls)
    steps = STEPS if high > low else 1
    for i in range(steps):
        pull = low + (high - low) * i / max(steps - 1, 1)
        origin = Rhino.Geometry.Point3d(highs[0] + 2.0 * size, lows[1] + 1.5 * size * i, lows[2])
        plane = Rhino.Geometry.Plane(origin, Rhino.Geometry.Vector3d(0.0, 0.0, 1.0))
        display.AddText("%.4g %s" % (pull, unit), plane, size, _colour(scale(pull)))


def _mark(display, point):
    from Rhino.Display import PointStyle

    from . import canvas_geometry as geometry

    display.AddPoint(geometry.to_point(point), _colour(MISSED), PointStyle.X, 6)


def _colour(parts):
    from System.Drawing import Color

    return Color.FromArgb(*parts)


def _display(key):
    """The display of a session, None where there is none."""
    if key not in _displays:
        try:
            from Rhino.Display import CustomDisplay
        except ImportError:
            return None
        _displays[key] = CustomDisplay(True)
    return _displays[key]
