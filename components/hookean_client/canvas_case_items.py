"""Load cases and combinations as text. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_geometry import TEXT, Unfit, listed, matched, missing
from .canvas_goals import _name, _number, _text
from .canvas_items import text
from .canvas_scene import read

PRESTRESS, PERMANENT = "prestress", "permanent"


def load_case(ghenv, loads, factor, heated, degrees, name):
    """A load case as text: its loads and changes of temperature, by the names of their forces."""

    def work():
        given = listed(loads)
        warm = [str(_name(item)) for item in listed(heated)]
        changes = [geometry.number(item) for item in listed(degrees)]
        if not given and not warm:
            raise missing("_loads is missing; connect the outputs of load components, or give their names")
        if bool(warm) != bool(changes):
            raise Unfit("heated and degrees belong together; connect both")
        own = {"forces": [str(_name(item)) for item in given]}
        if warm:
            own["temperature"] = dict(zip(*matched(warm, changes)))
        if listed(factor):
            own["factor"] = _number(factor, "factor")
        return _item(ghenv, "load_case", name, own, given)

    return words.told(ghenv, work)


def combination(ghenv, cases, factors, prestress, permanent, name):
    """A combination as text: factors on cases, on the prestress of the form and on loads in no case."""

    def work():
        names, numbers = [_called(item) for item in listed(cases)], [geometry.number(n) for n in listed(factors)]
        if not names and not listed(prestress) and not listed(permanent):
            raise missing("_cases is missing; connect the outputs of Load Case, or give their names")
        if len(numbers) not in (0, 1, len(names)):
            said = "factors: %d for %d cases; give one for all, or one for each"
            raise Unfit(said % (len(numbers), len(names)))
        own = dict(zip(names, (numbers or [1.0]) * (len(names) if len(numbers) < 2 else 1)))
        for title, given in ((PRESTRESS, prestress), (PERMANENT, permanent)):
            if listed(given):
                own[title] = _number(given, title)
        carried = [item for item in listed(cases) if _is_text(item)]
        return _item(ghenv, "combination", name, {"factors": own}, carried)

    return words.told(ghenv, work)


def _item(ghenv, kind, name, own, carried):
    """The text of a case or combination; `carried` are texts of what it names, so that they need no other wire."""
    source = words.source(ghenv)
    title = _text(name) or source["title"]
    parts = [str(item) for item in carried if _is_text(item)]
    return text({"kind": kind, "source": source, "name": title, "value": own, "parts": parts})


def _is_text(item):
    return isinstance(item, TEXT) and '"kind"' in item


def _called(item):
    """The name of a case: of its text, or the name itself."""
    if _is_text(item):
        return read([item], "load_case", "cases")[0]["name"]
    return str(item).strip()
