"""Examples: the figures of the source chapter, each a folder that runs, is drawn and is checked.

A folder holds `scene.py` with `scene(**parameters) -> Scene`, what the figure shows with its values as defaults;
`example.py` with `run(folder) -> Outcome`; `expected.json` with the numbers it is held to and where they come from;
`README.md` and `picture.png`. Where a figure begins in Rhino, `model.3dm` and `recipe.toml` hold the same scene. They
stand in `gh_examples/` of the project, and travel in the wheel.
"""

from __future__ import annotations

import difflib
import importlib.util
import inspect
import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from hookean.errors import InputError
from hookean.pictures.sheet import Graph, Panel, sheet

if TYPE_CHECKING:
    from hookean.scene.scene import Scene


@dataclass(frozen=True)
class Outcome:
    """What an example's `run` returns: its numbers by the names of expected.json, in the units given there, and what
    its picture shows. `title` is the heading of the picture."""

    numbers: Mapping[str, float]
    panels: Sequence[Panel | Graph]
    columns: int | None = None
    same_scale: bool = True
    size: tuple[int, int] | None = None

    @property
    def failures(self) -> list[str]:
        """Messages of the runs in its panels that ended neither at rest nor while moving."""
        results = [panel.result for panel in self.panels if isinstance(panel, Panel) and panel.result is not None]
        return [result.message for result in results if result.status not in ("converged", "running")]


class Expected(BaseModel):
    """An expected number of an example: `value` within `tolerance` (absolute, in `unit`), or bounds; and its `source`:
    `chapter: ...`, `closed form: ...` or `script NAME: ...`, a script beside it that does not import hookean."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    unit: str
    value: float | None = None
    tolerance: Annotated[float, Field(gt=0)] | None = None
    at_least: float | None = None
    at_most: float | None = None
    source: Annotated[str, Field(pattern=r"^(chapter|closed form|script [a-z_]+\.py): \S")]

    @model_validator(mode="after")
    def _whole(self) -> Expected:
        bounded = self.at_least is not None or self.at_most is not None
        if (self.value is None) == (not bounded) or (self.value is None) != (self.tolerance is None):
            raise ValueError("give value and tolerance, or at_least and at_most, or one of these two")
        return self

    def holds(self, number: float) -> bool:
        """Whether a number is what was expected."""
        if self.value is not None and self.tolerance is not None:
            return abs(number - self.value) <= self.tolerance
        low = -np.inf if self.at_least is None else self.at_least
        return low <= number <= (np.inf if self.at_most is None else self.at_most)

    def __str__(self) -> str:
        if self.value is not None:
            return f"{self.value:.9g} ± {self.tolerance:.1g}"
        if self.at_least is not None and self.at_most is not None:
            return f"{self.at_least:.9g} to {self.at_most:.9g}"
        return f"at least {self.at_least:.9g}" if self.at_least is not None else f"at most {self.at_most:.9g}"


class Expectations(BaseModel):
    """The file expected.json: title, what to see and try in a sentence, figures of the chapter it shows, numbers
    by name."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    title: str
    sentence: str = ""
    figures: tuple[str, ...]
    kind: Literal["chapter", "essay"] = "chapter"
    numbers: Annotated[dict[str, Expected], Field(min_length=1)]


@dataclass(frozen=True)
class Example:
    """One folder of examples."""

    folder: Path

    @property
    def name(self) -> str:
        return self.folder.name

    @cached_property
    def expected(self) -> Expectations:
        path = self.folder / "expected.json"
        try:
            return Expectations.model_validate(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError, ValidationError):
            raise InputError(str(path), "is missing or damaged; copy the example again") from None

    @property
    def original(self) -> bool:
        """Whether it is one of the project's, not a copy that was made to be changed."""
        return self.folder.resolve().parent == home().resolve()

    @property
    def figure(self) -> str:
        """What of the chapter it is, such as `Figures 9.4 and 9.5`."""
        return "The essay" if self.expected.kind == "essay" else _figures(self.expected.figures)

    @property
    def picture(self) -> Path:
        """Its picture (PNG): as the studio shows it, where there is one, else as it is drawn."""
        shown = self.folder / "studio.png"
        return shown if shown.is_file() else self.folder / "picture.png"

    @property
    def drawn(self) -> bool:
        """Whether it begins in Rhino: with a model and a recipe."""
        return (self.folder / "model.3dm").is_file()

    def scene(self) -> Scene:
        """Its scene, as drawn where it is, made fit to move (see `running.in_motion`)."""
        from hookean.files.relax_file import read_scene
        from hookean.running.in_motion import in_motion

        model, recipe = self.folder / "model.3dm", self.folder / "recipe.toml"
        return in_motion(read_scene(model, recipe) if self.drawn else figure(self.folder).scene())[0]

    def run(self) -> Outcome:
        """Run the example, and load its script again."""
        outcome: Any = _script(self.folder / "example.py").run(self.folder)
        assert isinstance(outcome, Outcome)
        return outcome

    def draw(self, outcome: Outcome, path: Path) -> None:
        """Its picture, as a PNG file."""
        sheet(
            outcome.panels, path, title=self.expected.title, columns=outcome.columns, same_scale=outcome.same_scale,
            size=outcome.size,
        )  # fmt: skip


def figure(folder: str | Path) -> ModuleType:
    """The module `scene.py` of a figure: of its folder's name in the gallery, or of a folder such as a copy. Its
    function `scene(**parameters)` makes a Scene; the defaults are the figure's values."""
    return _script(home() / folder / "scene.py")


def defaults(make: Callable[..., Any]) -> dict[str, Any]:
    """The parameters of a figure's function by their names, with their defaults: the figure's values."""
    found = {name: p.default for name, p in inspect.signature(make).parameters.items() if p.kind is not p.VAR_KEYWORD}
    return found | getattr(make, "keywords", {})


def _script(path: Path) -> ModuleType:
    """A script of an example as a module of its own, loaded at every call."""
    spec = importlib.util.spec_from_file_location(f"{path.stem}_of_{path.parent.name}", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def home() -> Path:
    """The folder of the examples: beside the installed package, or in the project."""
    package = Path(__file__).parents[1]
    return next(
        (place for place in (package / "gh_examples", package.parents[1] / "gh_examples") if place.is_dir()), package
    )


def examples() -> list[Example]:
    """All examples, in the order of the chapter, those of its essay last."""
    found = [Example(path.parent) for path in home().glob("*/expected.json")]
    return sorted(found, key=lambda e: ([int(p) for p in e.name.partition("-")[0].split(".") if p.isdigit()] or [99],
                                        e.name))  # fmt: skip


INTRODUCTION = """# Gallery

hookean follows a book chapter on particle-spring systems, and these examples reproduce its figures. Each is a folder
with its input, its script, and the numbers that tests compare it with, including their sources. `hookean example` lists
the examples, `hookean example 9.11` runs one, and `make figures` draws all of them and regenerates this page.

To start your own model from an example, copy its folder, change the input and run the copy. Its numbers are printed
beside those of the original.

```sh
hookean example 9.24 --copy roof
hookean example ./roof --picture roof/relaxed.png
```

Then use your own file. Print how it is interpreted, replace the layers in the recipe by those of your file, and relax
it:

```sh
hookean relax mine.3dm --recipe roof/recipe.toml --explain
hookean relax mine.3dm --recipe roof/recipe.toml -o relaxed.3dm --picture relaxed.png
```

Stiffness and loads of an example suit its size: 20 N that shape a roof of 10 m tear a model of 10 mm. `--explain`
prints how large your model is and in which units the numbers of the recipe are.
[rhino-files.md](../docs/rhino-files.md) describes recipes in full.

"""


def gallery(known: Sequence[Example]) -> str:
    """The page of pictures, in Markdown."""
    parts = []
    for example in known:
        title = example.expected.title
        parts.append(
            f"## [{example.figure}]({example.name}): {title}\n\n"
            f'<a href="{example.name}"><img src="{example.name}/picture.png" width="640" alt="{title}"></a>\n'
        )
        if (example.folder / "studio.png").is_file():
            parts.append(f'<img src="{example.name}/studio.png" width="640" alt="The same in the studio: {title}">\n')
    return INTRODUCTION + "\n".join(parts)


def _figures(figures: Sequence[str]) -> str:
    """Such as `Figure 9.4`, `Figures 9.4 and 9.6` or `Figures 9.23 to 9.25`; anything else is kept as it is."""
    first, *more = figures
    if not more or not all(re.fullmatch(r"\d+\.\d+", figure) for figure in figures):
        return f"Figure {first}" if first[0].isdigit() else first.capitalize()
    minor = [int(figure.partition(".")[2]) for figure in figures]
    if len(minor) > 2 and minor == list(range(minor[0], minor[0] + len(minor))):
        return f"Figures {first} to {more[-1]}"
    return f"Figures {', '.join(figures[:-1])} and {more[-1]}"


def find(wanted: str) -> Example:
    """The example of a folder's name, a figure's number, or in a folder such as a copy; InputError names near ones."""
    if wanted in (".", "..") or "/" in wanted or os.sep in wanted:
        return _beside(wanted)
    known, named = examples(), re.sub(r"^fig(ure|\.)?s?\s*", "", wanted.strip().casefold())
    for fits in (
        lambda e: e.name.casefold() == named,
        lambda e: e.name.partition("-")[2].casefold() == named,
        lambda e: e.name.partition("-")[0] == named,
        lambda e: named in e.expected.figures,
    ):
        for example in known:
            if fits(example):
                return example
    if (Path(wanted) / "example.py").is_file():
        return Example(Path(wanted).resolve())
    near = _near(named, [e.name for e in known])
    meant = f"; did you mean {' or '.join(near)}?" if near else ";"
    raise InputError(wanted, f"no example has this figure or name{meant} list all with: hookean example")


def _beside(wanted: str) -> Example:
    if not (Path(wanted) / "example.py").is_file():
        raise InputError(
            wanted, "is not a folder with an example.py; make one with: hookean example 9.24 --copy FOLDER"
        )
    return Example(Path(wanted).resolve())


def _near(named: str, known: Sequence[str]) -> list[str]:
    holding = [name for name in known if named and (named in name or name.partition("-")[0] == named.rstrip("0"))]
    words = {word: name for name in known for word in (name.partition("-")[2] or name, name.partition("-")[0])}
    return (holding or [words[word] for word in difflib.get_close_matches(named, words, 3, 0.6)])[:3]
