"""Lists of points and of whole numbers as the buffers in which they travel, and back. For Python 2.7 to 3.13."""

import base64
import struct

from . import buffer


def packed(value):
    """Lists of points and of whole numbers as buffers, all the way down; other values as they are."""
    if isinstance(value, dict):
        return {key: packed(one) for key, one in value.items()}
    flat = value if isinstance(value, (list, tuple)) else []
    if not flat or not isinstance(flat[0], (list, tuple)):
        return value
    while flat and isinstance(flat[0], (list, tuple)):
        flat = [part for row in flat for part in row]
    kinds = set(map(type, flat))
    if not flat or kinds & {dict, bool, type(None)}:
        return value
    return buffer(value, "d" if float in kinds else "q")


def unpacked(value):
    """The same with buffers as lists of lists."""
    if isinstance(value, list):
        return [unpacked(one) for one in value]
    if not isinstance(value, dict):
        return value
    if set(value) != {"dtype", "shape", "base64"}:
        return {key: unpacked(one) for key, one in value.items()}
    raw = base64.b64decode(value["base64"])
    code, size = {"<f8": ("d", 8), "<i8": ("q", 8), "<f4": ("f", 4), "<i4": ("i", 4)}[value["dtype"]]
    flat = list(struct.unpack("<%d%s" % (len(raw) // size, code), raw))
    for length in reversed(value["shape"][1:]):
        flat = [flat[i : i + length] for i in range(0, len(flat), length)] if length else [[]] * value["shape"][0]
    return flat
