"""Inputs of components with defaults: numbers, words and flags. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from .canvas_geometry import Unfit, listed


def default(given, value):
    """What is connected to an input, as a list, or a value where nothing is."""
    return listed(given) or [value]


def whole(given, value, name, least=1):
    """Whole numbers of an input, or a value where nothing is connected. Raises `Unfit` for anything else, or too small
    numbers."""
    found = []
    for item in default(given, value):
        try:
            number = geometry.number(item)
        except Unfit as unfit:
            raise Unfit("%s: %s" % (name, unfit))
        if number != int(number) or number < least:
            raise Unfit("%s: %s given; a whole number from %d on is expected" % (name, item, least))
        found.append(int(number))
    return found


def word(given, known, name):
    """The word connected to an input, which may be given as its number; the first one where nothing is."""
    item = default(given, known[0])[0]
    found = item.strip().lower() if isinstance(item, geometry.TEXT) else item
    if found not in known:
        try:
            found = known[int(geometry.number(found))]
        except (Unfit, IndexError):
            ways = ", ".join("%d %s" % pair for pair in enumerate(known))
            given = item if isinstance(item, geometry.NUMBERS) else geometry.called(item)
            raise Unfit("%s: %s is unknown; give one of %s" % (name, given, ways))
    return str(found)


def flag(given, value):
    """Whether an input is true; a value where nothing is connected."""
    return str(default(given, value)[0]).strip().lower() not in ("false", "0", "0.0", "no", "")
