"""Texts in addresses, compressed: raw deflate (RFC 1951) as base64url (RFC 4648) without padding."""

from __future__ import annotations

import base64
import binascii
import re
import zlib

from hookean.errors import InputError

LARGEST = 1_000_000  # bytes of a text


def is_packed(told: str) -> bool:
    """Whether a text is packed: JSON of an object is not."""
    return re.fullmatch(r"[\w-]+", told, re.ASCII) is not None


def packed(text: str) -> str:
    """A text of letters, digits, - and _ that has `text`."""
    made = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    data = made.compress(text.encode()) + made.flush()
    return base64.urlsafe_b64encode(data).decode().rstrip("=")


def unpacked(told: str, where: str) -> str:
    """The text that was packed. Raises InputError for what was cut, changed or is larger than `LARGEST`."""
    found = zlib.decompressobj(-zlib.MAX_WBITS)
    try:
        data = found.decompress(base64.urlsafe_b64decode(told + "=" * (-len(told) % 4)), LARGEST)
        if found.eof and not found.unused_data:
            return data.decode()
    except (binascii.Error, zlib.error, UnicodeDecodeError):
        pass
    raise InputError(
        where,
        f"{told[:40]!r} given; give a JSON object as text, or compressed (raw deflate, base64url) "
        f"with at most {LARGEST} bytes",
    )
