"""Where the real Rhino files are, and how to go through what they hold."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


def rhino_folder() -> Path:
    given = os.environ.get("HOOKEAN_TEST_RHINO")
    return Path(given) if given else Path(__file__).resolve().parents[3] / "shared" / "data" / "rhino"


@pytest.fixture(scope="session")
def rhino_objects() -> Callable[[str], list[tuple[Any, str]]]:
    """Geometry and name of the objects of a file; skips where the file is absent."""

    def read(file: str) -> list[tuple[Any, str]]:
        path = rhino_folder() / file
        if not path.is_file():
            pytest.skip(f"{file} is not there; set HOOKEAN_TEST_RHINO to the folder with the Rhino files")
        import rhino3dm

        model = rhino3dm.File3dm.Read(str(path))
        assert model is not None
        return [(o.Geometry.Duplicate(), o.Attributes.Name) for o in model.Objects]

    return read
