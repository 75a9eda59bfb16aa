"""Uploaded files: the form is taken apart, read and solved in a worker that is then replaced."""

from __future__ import annotations

import contextlib
import importlib
import io
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hookean.errors import InputError
from hookean_server.http import answers, claimed
from hookean_server.problems import Problem
from hookean_server.workers.deadline import limited
from hookean_server.workers.task import Cancelled, Clock, Done

MODEL = "model/vnd.3dm"
RECIPE_LIMIT = 2**20


def relax_upload(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The relaxed file, or with `options["answer"] == "report"` the report of its results as JSON; headers report how
    the run ended.

    Options: `path` of the multipart body, `content_type` with its boundary, `answer` (`file` or `report`), `seconds`,
    the longest solve [s]. The form has a part `file`, and may have a part `recipe` (TOML or JSON text). Raises
    InputError naming the part.
    """
    clock = Clock()
    with _beside(options["path"]) as folder:
        data, recipe, _ = parts(Path(options["path"]), options["content_type"])
        clock.lap("decode")
        source, target = Path(folder) / "upload.3dm", Path(folder) / "relaxed.3dm"
        source.write_bytes(data)
        report = options["answer"] == "report"
        try:
            done = _relax_file()(
                source, None if report else target, recipe, cancelled=cancelled,
                reading=limited(options["read_seconds"]), seconds=options["seconds"],
            )  # fmt: skip
        except InputError as error:
            if isinstance(error.__cause__, OSError):
                raise error.__cause__ from None  # our disk is at fault, not the file
            raise InputError(_place(error.pointer, recipe), error.sentence.replace(folder, "")) from None
        clock.lap("solve")
        said = claimed.headers(done.result, done.warnings)
        if report:
            return Done(answers.dump(done.to_dict(), "list"), headers=said, timing=clock.parts)
        if not target.exists():
            raise Problem("out-of-time", "This was stopped before it was finished, and nothing was written.")
        named = {"content-disposition": 'attachment; filename="relaxed.3dm"', **said}
        return Done(target.read_bytes(), MODEL, named, clock.parts)


def scene_upload(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The scene of an uploaded file, as JSON, fit to move, or the simulation that it saved; warnings in a header.
    Options and faults as `relax_upload`. Files are read as `hookean relax` reads them (see `hookean.files.readers`)."""
    from hookean.files.readers import read
    from hookean.running.in_motion import in_motion

    data, recipe, name = parts(Path(options["path"]), options["content_type"])
    try:
        with _beside(options["path"]), limited(options["read_seconds"]):
            found = read(data, name, None if recipe is None else (recipe, ""))
            if found.nothing:
                raise InputError("", found.nothing)
            if found.simulation is not None:
                stream = io.BytesIO()
                found.simulation.save(stream)  # what was understood of the file, and nothing else of it
                return Done(stream.getvalue(), "application/octet-stream")
            scene, said = in_motion(found.scene)
    except InputError as error:
        raise InputError(_pointer(error.pointer, recipe), error.sentence) from None
    notes = [*found.warnings, found.unheld, said]
    return Done(scene.canonical.encode(), headers=claimed.warned([note for note in notes if note]))


def _pointer(pointer: str, recipe: str | None) -> str:
    """Where a fault is in the form: those of a recipe lead into it, others into the file."""
    if pointer in ("recipe", "/recipe"):
        return "/recipe"
    inside = pointer.rstrip("/") if pointer.startswith("/") else ""
    return f"{'/file' if recipe is None else '/recipe'}{inside}" if inside else "/file"


def geometry_upload(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """What an uploaded file has drawn in it, as plain numbers; options as `relax_upload`, with `divisions` (a pair, or
    none) of surfaces and `arrays` (`list` or `buffer`)."""
    from hookean.files.rhino.plain import plain
    from hookean.files.rhino.read import parse

    clock = Clock()
    data, recipe, _ = parts(Path(options["path"]), options["content_type"])
    if recipe is not None:
        raise InputError("/recipe", "recipes are not supported here; send a form with the part file only")
    clock.lap("decode")
    try:
        with limited(options["read_seconds"]):
            found = plain(parse(data, "the file").model, options["divisions"])
    except InputError as error:
        raise InputError("/file", error.sentence) from None
    clock.lap("read")
    return Done(answers.dump(found, options["arrays"]), timing=clock.parts)


def recipe_upload(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The rows of an uploaded .3dm file with a role for each, and the recipe of these roles; options as `relax_upload`.
    The form has a part `file`, and may have a part `choices` (JSON). With `options["any"]` files of other programs are
    read, too; those that hold a whole model have no rows. Raises InputError naming the part."""
    from hookean.files.recipe.draft import draft, model_in, undrafted
    from hookean.files.recipe.foreign import SUFFIXES
    from hookean.files.rhino.read import parse as parse_model
    from hookean.scene.text import parse

    clock = Clock()
    data, choices, name = parts(Path(options["path"]), options["content_type"], "choices")
    clock.lap("decode")
    try:
        given = None if choices is None else parse(choices)
    except InputError as error:
        raise InputError("/choices", error.sentence) from None
    foreign = options.get("any") and Path(name).suffix.lower() in SUFFIXES
    try:
        with limited(options["read_seconds"]):
            model = model_in(data, name) if foreign else parse_model(data, name or "the file").model
    except InputError as error:
        raise InputError(_pointer(error.pointer, None) if foreign else "/file", error.sentence) from None
    clock.lap("read")
    try:
        with limited(options["read_seconds"]):
            found = undrafted(Path(name).name) if model is None else draft(model, given).to_dict()
    except InputError as error:
        if not error.pointer.startswith("/"):
            raise InputError("/file", str(error)) from None
        raise InputError(f"/choices{error.pointer}".rstrip("/"), error.sentence) from None
    clock.lap("draft")
    return Done(answers.dump(found, "list"), timing=clock.parts)


@contextlib.contextmanager
def _beside(path: str) -> Iterator[str]:
    """A folder for what is written meanwhile, beside the body: the server takes both away, also where this process is
    ended."""
    before = tempfile.tempdir
    try:
        with tempfile.TemporaryDirectory(prefix="hookean-", dir=Path(path).parent) as folder:
            tempfile.tempdir = folder
            yield folder
    finally:
        tempfile.tempdir = before


def parts(path: Path, content_type: str, beside: str = "recipe") -> tuple[bytes, str | None, str]:
    """The bytes of the part `file`, the text of the part `beside` it and the file's name of a multipart form on
    disk."""
    from python_multipart import exceptions, parse_form

    found: dict[str, bytes] = {}
    name = ""

    def put(name: bytes | None, value: bytes) -> None:
        key = (name or b"").decode("utf-8", "replace")
        if key not in ("file", beside) or key in found:
            why = (
                "this part is given twice"
                if key in found
                else f"unknown part; the form may have the parts file and {beside}"
            )
            raise InputError(f"/{key[:80]}", why)
        found[key] = value

    def on_file(file: Any) -> None:
        nonlocal name
        if file.field_name == b"file":
            name = (file.file_name or b"").decode("utf-8", "replace")
        file.file_object.seek(0)
        put(file.field_name, file.file_object.read())

    headers = {"Content-Type": content_type.encode("latin-1", "replace")}
    try:
        with path.open("rb") as stream:
            parse_form(headers, stream, lambda field: put(field.field_name, field.value or b""), on_file)
    except (exceptions.FormParserError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            "/", "the body is not a multipart form; send it as multipart/form-data with a boundary"
        ) from None
    if found.get("file") == b"":
        raise InputError(
            "/file", "the file is empty (0 bytes); save it again in the program that it is from, or choose another file"
        )
    if "file" not in found:
        raise InputError("/file", "the form needs a part named file with the file in it")
    text = found.get(beside)
    if text is not None and len(text) > RECIPE_LIMIT:
        raise InputError(f"/{beside}", f"longer than {RECIPE_LIMIT} bytes")
    try:
        return found["file"], text.decode("utf-8") if text else None, name
    except UnicodeDecodeError:
        raise InputError(f"/{beside}", "the text is not UTF-8") from None


def _place(pointer: str, recipe: str | None) -> str:
    """The part of the form a fault is in: pointers lead into the recipe, names are those of the file or the recipe."""
    if pointer.startswith("/") and not Path(pointer).name.endswith(".3dm"):
        return f"/recipe{pointer}" if recipe is not None else "/file"
    return "/recipe" if pointer == "recipe" else "/file"


def _relax_file() -> Any:
    try:
        return importlib.import_module("hookean.files.relax_file").relax_file
    except (ImportError, AttributeError):
        raise Problem("not-found", "This installation cannot relax files.") from None
