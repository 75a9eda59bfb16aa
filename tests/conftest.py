"""What all tests have in common."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from soak import SOAK

# how long an example takes is the machine's affair, and no test is about it
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")


LONGEST_FIRST = ("docs", "studio", "server", "faults", "fuzz", "components", "canvas", "laws")
"""Folders whose tests take long; they run before the others, so that no worker is left alone with one of them."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave what takes long to `make soak`; begin with the folders of `LONGEST_FIRST`."""
    left = [] if SOAK else [item for item in items if item.get_closest_marker("soak")]
    if left:
        config.hook.pytest_deselected(items=left)
        items[:] = [item for item in items if not item.get_closest_marker("soak")]
    places = {folder: place for place, folder in enumerate(LONGEST_FIRST)}
    items.sort(key=lambda item: places.get(item.path.parent.name, len(places)))


@pytest.fixture(scope="session", autouse=True)
def own_state(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Whatever looks for a server finds none of the person who runs the tests, and starts none beside theirs. The
    definitions of tests are trusted, as in CI."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOOKEAN_TRUST", "1")
        patch.setenv("HOOKEAN_STATE", str(tmp_path_factory.mktemp("state")))
        yield
