"""What takes a minute alone begins first: begun last, it would run while the other process has nothing left to do."""

from __future__ import annotations

import pytest

LONG = ("studio/test_soak.py", "server/test_kills.py", "test_packaging.py")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """In order of files as before, but for the long ones."""
    items.sort(key=lambda item: not item.path.as_posix().endswith(LONG))
