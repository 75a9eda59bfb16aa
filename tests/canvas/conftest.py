"""What tests of components share: a server that they find, and a canvas of stand-ins."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from canvas.canvasing import let_go
from hookean_canvas.run import stand_in
from hookean_client import canvas_link
from serving import Home


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A server that components find; what plays on it is let go at the end."""
    with pytest.MonkeyPatch.context() as patch:
        found = Home(tmp_path_factory.mktemp("state"))
        found.serve()
        patch.setenv("HOOKEAN_STATE", str(found.folder))
        canvas_link.service.forget()
        yield found
        let_go()
    found.end()


@pytest.fixture
def canvas() -> Iterator[Any]:
    """Rhino and Grasshopper as stand-ins while a test runs."""
    made = stand_in.Canvas().install()
    yield made
    made.remove()
