"""Showing a scene in the studio: what `show` takes and gives. The package that serves the studio does it."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene

STUDIO = "hookean_server.lifecycle.show"  # found when something is shown, not before


def show(
    scene: Scene | Result | Simulation | Mapping[str, Any], *, name: str = "", browser: bool | None = None
) -> View:
    """Open the studio, the page of the service, on a scene, a result or a simulation; returns its `View`.

    The service of this user is used, or started; it outlives this program, and ends after an hour without use. A result
    is shown in its shape, a simulation as it stands. The same `name` (letters, digits and . _ : ~ -) shows the next
    scene in the same page. `browser`: whether to open a browser; None: unless this is a notebook, where the last line
    of a cell shows the page below it.

    Raises InputError for an invalid scene or name, ConnectionError where no service can be started or none answers.
    """
    opened: View = importlib.import_module(STUDIO).show(scene, name, browser)
    return opened


@dataclass(frozen=True)
class Picked:
    """What is picked in the page: its `kind`, particle or spring, and its number `index`."""

    kind: str
    index: int


@dataclass(frozen=True)
class Edited:
    """An edit made in the page: the `revision` it led to, and the `patch`, as `Simulation.patch` takes it, with its
    gesture; `{"undo": True}`, `redo` and `reset` for these."""

    revision: int
    patch: dict[str, Any]


class View(ABC):
    """A scene that is shown in the studio. In a notebook it is the page.

    What fails raises InputError where the input is at fault, ConnectionError where the service does not answer or the
    session was deleted.
    """

    @property
    @abstractmethod
    def url(self) -> str:
        """The address of the page. It has no token: a browser that is not logged in asks for it."""

    @property
    @abstractmethod
    def pick(self) -> Picked | None:
        """What is picked in the page; None for nothing."""

    @property
    @abstractmethod
    def scene(self) -> Scene:
        """The scene with all edits, with its particles where they start."""

    @property
    @abstractmethod
    def particles(self) -> NDArray[np.float64]:
        """Where the particles are now, (n, 3) [length]."""

    @abstractmethod
    def on_edit(self, callback: Callable[[Edited], object]) -> Callable[[Edited], object]:
        """Call `callback` with each edit that others make from now on, in the page above all, in a thread of its own.
        A drag is one edit whose target changes. Returns the callback, so this is a decorator, too."""

    @abstractmethod
    def update(
        self,
        scene: Scene | Result | Simulation | Mapping[str, Any] | None = None,
        *,
        positions: ArrayLike | None = None,
        values: ArrayLike | None = None,
        title: str = "Values",
        unit: str = "-",
    ) -> None:
        """Show something else in the page.

        `scene`: another scene, whose particles stay where they are now if they start where one of the old scene did; or
        a result or simulation in its shape. `positions` (n, 3) [length]: the particles of this scene elsewhere, at
        rest. Both replace the model, so earlier edits cannot be undone. `values`: numbers that colour the springs, one
        for each spring (in the order of the scene's forces) or one for each particle; a spring then has the mean of its
        ends. `title` and `unit` are shown in the legend.
        """

    @abstractmethod
    def close(self) -> None:
        """Stop calling callbacks and delete the session: the page shows that it is gone."""
