"""The kinds of files that are read, in one list: for the command line, the studio and HTTP alike.

A file is read by its ending, or else by how it begins; the same file gives the same scene everywhere. A new kind
is one line in `READERS`.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hookean.errors import InputError, refuse_pointer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from hookean.files.recipe.build import Built
    from hookean.files.rhino.model import Model
    from hookean.running.simulation import Simulation
    from hookean.scene.scene import Scene

MODEL = b"3D Geometry File Format"
Recipe = tuple[str, str]
"""The text of a recipe, and how faults call it: "" where their pointers lead into it alone."""


@dataclass(eq=False)
class Source:
    """A file read: its scene, lines for a person on how it was read, and warnings.

    Of a .3dm file, what its objects were built into; `factor` is a length of the file in the scene's unit, `unit` the
    file's. `compas` is the Mesh or Graph that the file is; `stored` is true where the scene is the one that hookean
    stored in a file of another format. `simulation` is the saved one, in the shape to go on from; `view` and `variants`
    are those of a .hookean file. `nothing` and
    `unheld` are sentences on why it cannot be relaxed as it is: it has nothing to relax, or nothing of it is held.
    """

    scene: Scene
    lines: list[str]
    built: Built | None = None
    factor: float = 1.0
    unit: str = ""
    warnings: tuple[str, ...] = ()
    compas: Any = None
    stored: bool = False
    simulation: Simulation | None = None
    view: dict[str, Any] = field(default_factory=dict)
    variants: dict[str, Simulation] = field(default_factory=dict)
    nothing: str = ""
    unheld: str = ""


@dataclass(frozen=True)
class Reader:
    """A kind of file: its name in a sentence, its ending, how its bytes begin, and what reads them; `recipes`:
    whether it supports recipes."""

    name: str
    suffix: str
    begins: Callable[[bytes], bool]
    read: Callable[[bytes, str, Recipe | None], Source]
    recipes: bool = False


def reader(data: bytes, name: str = "") -> Reader:
    """What reads a file of this name that begins with these bytes. InputError where nothing does."""
    suffix = Path(name).suffix.lower()
    begins = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    for known in (*(r for r in READERS if r.suffix == suffix), *(r for r in READERS if r.begins(begins))):
        return known
    raise InputError("", f"cannot be opened; give a {endings()} file")


def endings() -> str:
    """The endings of all files that are read, for a sentence."""
    *some, last = (known.suffix for known in READERS)
    return f"{', '.join(some)} or {last}"


def read(data: bytes, name: str = "", recipe: Recipe | None = None, *, called: str = "") -> Source:
    """What the bytes of a file hold; `name` is the file's, by which its kind is known, `called` how faults call it ("":
    their pointers lead into the file alone).

    Raises InputError: an unknown kind, a fault in the file (of OBJ with its line) or in the recipe.
    """
    refuse_pointer(data, called)
    with about(called):
        kind = reader(data, name)
    if recipe is not None and not kind.recipes:
        raise InputError(
            called or "/recipe",
            f"is {kind.name}, which does not support a recipe; recipes are for files with drawn objects (.3dm, .obj, "
            "COMPAS documents)",
        )
    return kind.read(data, called, recipe)


def read_path(path: Path, recipe: Recipe | None = None) -> Source:
    """What the file at `path` holds; faults are called by its name. Raises InputError, also where it cannot be read."""
    from hookean.atomic_write import read_bytes

    name = path.name or str(path)
    if path.suffix.lower() == ".toml":
        raise InputError(name, "is a recipe; pass it with -r, and give a .3dm file to relax")
    return read(read_bytes(path, name), name, recipe, called=name)


@contextmanager
def about(name: str, source: str = "") -> Iterator[None]:
    """Faults inside are those of a file or recipe of this name: their pointers stand behind it; a fault of an object in
    `source` behind that."""
    try:
        yield
    except InputError as error:
        if source and error.pointer and not error.pointer.startswith(("/", source)):
            raise InputError(f"{source}: {error.pointer}", error.sentence) from None
        if not name or error.pointer and not error.pointer.startswith("/"):
            raise
        raise InputError(f"{name} {error.pointer.rstrip('/')}".strip(), error.sentence) from None


def _threedm(data: bytes, called: str, recipe: Recipe | None) -> Source:
    # loads rhino3dm, which other files need not
    from hookean.files import embedded
    from hookean.files.recipe.recipe import understand
    from hookean.files.rhino.read import parse
    from hookean.scene.text import parse_tables

    tables = None if recipe is None else parse_tables(recipe[0], recipe[1] or "recipe")
    model = parse(data, called or "the file").model
    with about(called if recipe is None else recipe[1], called):
        understood = understand(model, tables)
    if understood.nothing and recipe is None and embedded.KEY in model.text:
        return _stored(model, called)
    seen = understood.built.drawing
    return Source(
        understood.built.scene,
        understood.lines,
        understood.built,
        seen.factor,
        seen.unit,
        (*model.warnings, *understood.notes),
        nothing=understood.nothing,
    )


def _stored(model: Model, called: str) -> Source:
    """The scene that hookean stored in a .3dm file in which nothing is drawn but its results."""
    from hookean.files import embedded
    from hookean.scene.scene import Scene
    from hookean.values.units import METRES

    with about(called):
        scene = Scene.read(embedded.unpacked(model.text[embedded.KEY], ""))
    source = _plain(scene, called, "the scene stored in this file (its objects are results)", (), "")
    source.factor = (model.metres or METRES[scene.units.length]) / METRES[scene.units.length]
    source.stored, source.warnings = True, tuple(model.warnings)
    source.lines += model.warnings
    return source


def _by_recipe(data: bytes, called: str, suffix: str, recipe: Recipe) -> Source:
    """A file of another program by a recipe; results are not written back into it."""
    from hookean.files.recipe.foreign import drawn_in, model_of
    from hookean.files.recipe.recipe import understand
    from hookean.scene.text import parse_tables

    tables = parse_tables(recipe[0], recipe[1] or "recipe")
    with about(called):
        drawn = drawn_in(data, suffix)
    if drawn is None:
        said = "holds a whole model; recipes are for files with drawn objects (.3dm, .obj, COMPAS documents)"
        raise InputError(called or "/recipe", said)
    model = model_of(drawn, called or "the file")
    with about(recipe[1], called):
        understood = understand(model, tables)
    found = understood.built.drawing
    warnings = (*model.warnings, *understood.notes)
    return Source(
        understood.built.scene, understood.lines, unit=found.unit, warnings=warnings, nothing=understood.nothing
    )


def _obj(data: bytes, called: str, recipe: Recipe | None) -> Source:
    if recipe is not None:
        return _by_recipe(data, called, ".obj", recipe)
    from hookean.files import obj_read
    from hookean.files.drawn import tables_of
    from hookean.scene.scene import Scene

    with about(called):
        tables, warnings, unheld = tables_of(obj_read.read(data))
        scene = Scene.read(tables)
    return _plain(scene, called, "an OBJ file, read as drawn,", tuple(warnings), unheld)


def _json(data: bytes, called: str, recipe: Recipe | None) -> Source:
    if recipe is not None:
        return _by_recipe(data, called, ".json", recipe)
    from hookean.files.documents import plain
    from hookean.scene.scene import Scene
    from hookean.scene.text import parse

    value = parse(data, called or "/")
    with about(called):
        found = plain(value)
        scene = Scene.read(found.scene)
    drawn = isinstance(value, list) or "dtype" in value
    what = "COMPAS documents, read as drawn," if drawn else "a scene"
    what = what if found.whole is None else f"a COMPAS {found.whole.kind}"
    what = f"the scene stored in {what}" if found.stored else what
    source = _plain(scene, called, what, found.warnings, found.unheld)
    source.compas, source.stored = found.whole, found.stored
    if found.whole is not None and not found.stored:
        held = "naked vertices" if found.whole.kind == "mesh" else "nodes of one edge"
        source.lines.append(f"a document without a scene: its edges are springs of rest factor 0, its {held} are held")
    return source


def _saved(data: bytes, called: str, recipe: Recipe | None) -> Source:
    from hookean.files import saved

    simulation = saved.read(data, called)
    source = _plain(simulation.edited_scene(), called, "a saved simulation", (), "")
    source.simulation = simulation
    return source


def _project(data: bytes, called: str, recipe: Recipe | None) -> Source:
    from hookean.files import project

    found = project.read(data, called)
    source = _plain(found.simulation.edited_scene(), called, "a model with its state", (), "")
    source.simulation, source.view, source.variants = found.simulation, found.view, found.variants
    if found.variants:
        source.lines.append(f"variants: {', '.join(found.variants)}")
    return source


def _is_project(begins: bytes) -> bool:
    from hookean.files import project

    return project.begins(begins)


def _plain(scene: Scene, called: str, what: str, warnings: tuple[str, ...], unheld: str) -> Source:
    forces = ", ".join(f.kind_name for f in scene.forces) or "no force"
    units = scene.units
    lines = [
        f"{called}: {what} with {forces}; {len(scene.anchors)} anchors, {len(scene.geometry)} carried geometries",
        f"units: {units.length}, {units.force}, {units.time}",
        *warnings,
        *([unheld] if unheld else []),
    ]
    return Source(scene, lines, unit=units.length, warnings=warnings, unheld=unheld)


READERS = (
    Reader("a Rhino model", ".3dm", lambda begins: begins.startswith(MODEL), _threedm, recipes=True),
    Reader(
        "an OBJ file",
        ".obj",
        lambda begins: any(line.split(b" ")[0] in (b"v", b"vn", b"o", b"g", b"mtllib") for line in begins.splitlines()),
        _obj,
        recipes=True,
    ),
    Reader("a JSON file", ".json", lambda begins: begins.startswith((b"{", b"[")), _json, recipes=True),
    Reader(
        "a saved simulation",
        ".npz",
        lambda begins: begins.startswith(b"PK\x03\x04") and not _is_project(begins),
        _saved,
    ),
    Reader("a model with its state", ".hookean", lambda begins: _is_project(begins), _project),
)
"""Every kind of file that is read; for an unknown ending the first that knows its bytes."""
