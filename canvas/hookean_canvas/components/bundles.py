"""Component bundles: a folder with code.py, metadata.json and icon.png, read and checked."""

from __future__ import annotations

import ast
import json
import keyword
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import NAMESPACE_URL, UUID, uuid5

from hookean.errors import InputError
from hookean_canvas.archive import guids
from hookean_canvas.components import icons

HINTS = tuple(guids.HINTS)
"""Type hints by the names a bundle's metadata uses."""

NO_ID = UUID(int=0)
SUBCATEGORIES = ("Engine", "Forces", "Geometry", "Mesh", "COMPAS")
EXPOSURES = (-1, 2, 4, 8, 16, 32, 64, 128)
FILES = ("code.py", "metadata.json", "icon.png")
_TOP = {"name", "nickname", "category", "subcategory", "description", "exposure", "instanceGuid", "ghpython"}
_PYTHON = {"isAdvancedMode", "iconDisplay", "hideOutput", "hideInput", "marshalGuids", "marshalOutGuids"}
_PARAMETER = {"name", "nickname", "description", "optional", "allowTreeAccess", "showTypeHints", "scriptParamAccess"}
_PARAMETER |= {"typeHintID", "wireDisplay", "sourceCount", "reverse", "simplify", "flatten", "graft"}


@dataclass(frozen=True)
class Parameter:
    """An input or output: `name` is the variable of the script; `access` is 0 item, 1 list, 2 tree."""

    name: str
    description: str
    hint: str = "none"
    access: int = 0
    optional: bool = True
    mapping: int = 0  # 1: flattened, 2: grafted
    reverse: bool = False
    simplify: bool = False
    wire: int = 0  # 0: as usual, 1: faint, 2: hidden


@dataclass(frozen=True)
class Bundle:
    """One component as its bundle describes it; `folder` is the folder's name, `icon` the bytes of a PNG."""

    folder: str
    name: str
    nickname: str
    subcategory: str
    description: str
    code: str
    icon: bytes = field(repr=False)
    inputs: tuple[Parameter, ...] = ()
    outputs: tuple[Parameter, ...] = ()
    category: str = "Hookean"
    exposure: int = 2
    guid: UUID = NO_ID
    icon_display: int = 2

    @property
    def rhino8_only(self) -> bool:
        """Whether the code asks for packages (`# r: compas`), which only Rhino 8 and newer can install."""
        return bool(re.search(r"(?m)^#\s*(r|requirements)\s*:", self.code))


def folder() -> Path:
    """Where the bundles are: `components` of the source tree, or what the installed package carries."""
    package = Path(__file__).resolve().parents[1]
    carried = package / "component_sources"
    return carried if carried.is_dir() else package.parents[1] / "components"


def names(place: Path | None = None) -> list[str]:
    """The bundles in a folder (none: the shipped ones), sorted."""
    return sorted(p.parent.name for p in (place or folder()).glob("*/metadata.json"))


def read_all(place: Path | None = None) -> list[Bundle]:
    """All bundles of a folder (none: the shipped ones), sorted; InputError where one is wrong or two share an id."""
    found = [read((place or folder()) / name) for name in names(place)]
    for what in ("guid", "name"):
        seen: dict[Any, str] = {}
        for bundle in found:
            other = seen.setdefault(getattr(bundle, what), bundle.folder)
            if other != bundle.folder:
                raise InputError(bundle.folder, f"has the same {what} as {other}; give each component its own.")
    return found


def read(place: Path | str) -> Bundle:
    """One bundle, by its folder or by the name of a shipped one; raises InputError with its fault."""
    place = folder() / place if isinstance(place, str) and "/" not in place else Path(place)
    drawn = not (place / "icon.png").is_file() and icons.known(place.name)  # until `components/generate.py` writes it
    missing = [name for name in FILES if not (place / name).is_file() and not (drawn and name == "icon.png")]
    if missing:
        raise InputError(
            place.name, f"is not a complete bundle: {', '.join(missing)} missing; it needs {', '.join(FILES)}."
        )
    icon = icons.png(place.name) if drawn else (place / "icon.png").read_bytes()
    if icon[:8] != b"\x89PNG\r\n\x1a\n" or icon[16:24] != bytes((0, 0, 0, 24, 0, 0, 0, 24)):
        raise InputError(
            f"{place.name}/icon.png", "is not a PNG of 24 x 24 pixels; `components/generate.py` draws one."
        )
    code = (place / "code.py").read_text(encoding="utf-8")
    _check_code(f"{place.name}/code.py", code)
    where = f"{place.name}/metadata.json"
    try:
        metadata = json.loads((place / "metadata.json").read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(where, f"is not valid JSON: {error}.") from None
    return _bundle(place.name, where, metadata, code, icon)


def identity(name: str) -> UUID:
    """The id of the component whose bundle folder is `name`, the same in every build."""
    return uuid5(NAMESPACE_URL, f"hookean component {name}")


def _bundle(name: str, where: str, metadata: dict[str, Any], code: str, icon: bytes) -> Bundle:
    _known(where, metadata, _TOP, ("name", "nickname", "category", "subcategory"))
    python = metadata.get("ghpython", {})
    _known(f"{where}, ghpython", python, _PYTHON | {"inputParameters", "outputParameters"}, ())
    if metadata["subcategory"] not in SUBCATEGORIES:
        raise InputError(where, f"subcategory {metadata['subcategory']!r} is not one of {', '.join(SUBCATEGORIES)}.")
    if metadata.get("exposure", 2) not in EXPOSURES:
        raise InputError(where, f"exposure {metadata['exposure']!r} is not one of {', '.join(map(str, EXPOSURES))}.")
    if python.get("isAdvancedMode"):
        raise InputError(where, "isAdvancedMode is true; components are plain scripts, the same in every Rhino.")
    inputs = _parameters(f"{where}, inputParameters", python.get("inputParameters", []))
    outputs = _parameters(f"{where}, outputParameters", python.get("outputParameters", []))
    both = [p.name for p in inputs + outputs]
    twice = sorted({n for n in both if both.count(n) > 1})
    if twice:
        raise InputError(where, f"{', '.join(twice)} given twice; inputs and outputs share one script and its names.")
    return Bundle(
        folder=name,
        name=metadata["name"],
        nickname=metadata["nickname"],
        subcategory=metadata["subcategory"],
        description=metadata.get("description", ""),
        code=code,
        icon=icon,
        inputs=inputs,
        outputs=outputs,
        category=metadata["category"],
        exposure=metadata.get("exposure", 2),
        guid=UUID(metadata["instanceGuid"]) if metadata.get("instanceGuid") else identity(name),
        icon_display=python.get("iconDisplay", 2),
    )


def _parameters(where: str, entries: Iterable[dict[str, Any]]) -> tuple[Parameter, ...]:
    found = []
    for i, entry in enumerate(entries):
        here = f"{where}[{i}]"
        _known(here, entry, _PARAMETER, ("name",))
        name = entry.get("nickname", entry["name"])
        if not name.isidentifier() or keyword.iskeyword(name):
            raise InputError(here, f"nickname {name!r} is not a variable name, by which the script reads the input.")
        if entry.get("typeHintID", "none") not in HINTS:
            raise InputError(here, f"typeHintID {entry['typeHintID']!r} is not one of {', '.join(HINTS)}.")
        access = entry.get("scriptParamAccess", "item")
        access = ("item", "list", "tree").index(access) if access in ("item", "list", "tree") else access
        if access not in (0, 1, 2):
            raise InputError(here, f"scriptParamAccess {access!r} is not one of item, list, tree.")
        if entry.get("flatten") and entry.get("graft"):
            raise InputError(here, "flatten and graft are both true; give one.")
        found.append(
            Parameter(
                name=name,
                description=entry.get("description", ""),
                hint=entry.get("typeHintID", "none"),
                access=access,
                optional=entry.get("optional", True),
                mapping=1 if entry.get("flatten") else 2 if entry.get("graft") else 0,
                reverse=entry.get("reverse", False),
                simplify=entry.get("simplify", False),
                wire=entry.get("wireDisplay", 0),
            )
        )
    return tuple(found)


def _known(where: str, given: dict[str, Any], allowed: set[str], required: Iterable[str]) -> None:
    unknown = sorted(set(given) - allowed)
    if unknown:
        raise InputError(where, f"has unknown keys {', '.join(unknown)}; allowed are {', '.join(sorted(allowed))}.")
    missing = [key for key in required if not given.get(key)]
    if missing:
        raise InputError(where, f"lacks {', '.join(missing)}.")


def _check_code(where: str, code: str) -> None:
    """Python 2.7 reads a script without an encoding only in ASCII, and Grasshopper's help shows the docstring."""
    if not code.isascii():
        line = next(i for i, text in enumerate(code.splitlines(), 1) if not text.isascii())
        raise InputError(f"{where}:{line}", "is not ASCII, which Python 2.7 cannot read; write `^2` and `phi`.")
    try:
        tree = ast.parse(code)
    except SyntaxError as error:
        raise InputError(f"{where}:{error.lineno}", f"does not compile: {error.msg}.") from None
    if not ast.get_docstring(tree):
        raise InputError(where, "has no docstring, which a right click shows as help.")
