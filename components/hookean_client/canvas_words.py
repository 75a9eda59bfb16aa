"""Sentences and times on a component, and who it is.

Bad input is never raised: it becomes one sentence on the component (`told`). For Python 2.7 to 3.13.
"""

from .canvas_geometry import Unfit


def identity(ghenv):
    """The id of a component as text."""
    return str(ghenv.Component.InstanceGuid)


def run_of(ghenv):
    """Which run of its solution a component is in, from 1."""
    return int(getattr(ghenv.Component, "RunCount", 1) or 1)


def say(ghenv, level, sentence):
    """A sentence on the component, once in a solution; `level`: Error, Warning or Remark."""
    from Grasshopper.Kernel import GH_RuntimeMessageLevel

    if not shows(ghenv, sentence):
        ghenv.Component.AddRuntimeMessage(getattr(GH_RuntimeMessageLevel, level), sentence)


def shows(ghenv, sentence):
    """Whether a component shows this message already."""
    from Grasshopper.Kernel import GH_RuntimeMessageLevel as levels

    known = getattr(ghenv.Component, "RuntimeMessages", lambda _: ())
    return any(sentence in list(known(level)) for level in (levels.Error, levels.Warning, levels.Remark))


def error(ghenv, sentence):
    """What went wrong; the component turns red."""
    say(ghenv, "Error", sentence)


def warning(ghenv, sentence):
    """What a person should know; the component turns orange."""
    say(ghenv, "Warning", sentence)


def remark(ghenv, sentence):
    """What may be of interest."""
    say(ghenv, "Remark", sentence)


def note(ghenv, text):
    """A few words under the component; "" takes them away."""
    ghenv.Component.Message = text


def schedule(ghenv, milliseconds):
    """Solve this component again after so long."""
    component, document = ghenv.Component, ghenv.Component.OnPingDocument()
    if document is None:
        return
    from Grasshopper.Kernel import GH_Document

    document.ScheduleSolution(
        int(milliseconds), GH_Document.GH_ScheduleDelegate(lambda _: component.ExpireSolution(False))
    )


def source(ghenv):
    """Who an item comes from: component, its name for people, and the run."""
    component = ghenv.Component
    title = str(getattr(component, "NickName", "") or getattr(component, "Name", ""))
    return {"component": identity(ghenv), "title": title, "run": run_of(ghenv)}


def told(ghenv, make):
    """What `make()` makes; None where it raises `Unfit`, which becomes a sentence on the component."""
    try:
        return make()
    except Unfit as unfit:
        text = str(unfit)
        level = "Warning" if getattr(unfit, "missing", False) else "Error"
        say(ghenv, level, text[:1].upper() + text[1:] + "." * (not text.endswith(".")))
        return None
