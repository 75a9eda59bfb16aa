"""What all tests have in common."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from soak import SOAK

# how long an example takes is the machine's affair, and no test is about it
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave what takes long to `make soak`."""
    left = [] if SOAK else [item for item in items if item.get_closest_marker("soak")]
    if left:
        config.hook.pytest_deselected(items=left)
        items[:] = [item for item in items if not item.get_closest_marker("soak")]


@pytest.fixture(scope="session", autouse=True)
def own_state(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Whatever looks for a server finds none of the person who runs the tests, and starts none beside theirs. The
    definitions of tests are trusted, as in CI."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOOKEAN_TRUST", "1")
        patch.setenv("HOOKEAN_STATE", str(tmp_path_factory.mktemp("state")))
        yield
