"""Texts in addresses: what is packed is unpacked to the same, and what is damaged or too large is refused."""

from __future__ import annotations

import re
from urllib.parse import quote

import pytest

from hookean.errors import InputError
from hookean_server.http.packing import LARGEST, is_packed, packed, unpacked

GROUPS = '{"groups": {"Ränder": ' + str(list(range(6000))) + "}}"


def test_packed_texts_are_short_and_the_same_again() -> None:
    """6000 numbers in their order are less than half as long as they are quoted, and need no quoting."""
    made = packed(GROUPS)
    assert unpacked(made, "view") == GROUPS
    assert len(made) < len(quote(GROUPS)) / 2 and re.fullmatch("[A-Za-z0-9_-]+", made)
    assert is_packed(made) and not is_packed(GROUPS) and not is_packed("")


@pytest.mark.parametrize(
    "told", [packed(GROUPS)[:-9], packed("{}") + packed("{}"), "A", "null", packed(" " * (LARGEST + 1))]
)
def test_what_is_not_packed_is_refused(told: str) -> None:
    """Cut, followed by more, of no whole byte, no compressed text, or a small text of a large one."""
    with pytest.raises(InputError, match="give a JSON object as text, or compressed"):
        unpacked(told, "view")
