"""Forces by their kinds: each is its file, found without a list of them and loaded when it is asked for."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from hookean import forces
from hookean.forces import KINDS, Force


def test_a_kind_is_the_name_of_its_file() -> None:
    """The order is that of the files; files without a force, other modules and no words at all are no kinds."""
    files = [path.stem for path in sorted(Path(forces.__file__ or "").parent.glob("*.py"))]
    assert list(KINDS) == [file for file in files if file in KINDS] and len(KINDS) == len(list(KINDS)) > 70
    for kind, cls in KINDS.items():
        assert (cls.kind_name, cls.__module__) == (kind, f"hookean.forces.{kind}")
        assert getattr(forces, cls.__name__) is cls and not cls.variant
    assert not {"base", "groups", "moments", "__init__", "os.path", "..springs", "", "Springs"} & {*KINDS}
    assert not any(word in KINDS for word in ("base", "groups", "moments", "os.path", "..springs", "", "Springs"))
    with pytest.raises(AttributeError):
        _ = forces.Unheard


def test_a_file_has_the_name_of_its_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    """A force in a file of another name would not be found: the class that is there is named, and the file it needs."""
    tide = ModuleType("hookean.forces.tide")
    vars(tide)["Wave"] = type(
        "Wave", (Force,), {"__module__": tide.__name__, "__annotations__": {"kind": str}, "kind": "wave"}
    )
    monkeypatch.setattr(forces.importlib, "import_module", lambda _: tide)
    with pytest.raises(TypeError, match=r"tide.py has the force 'wave': call the file wave.py"):
        forces._class_in("tide")
