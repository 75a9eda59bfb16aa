"""A scene inside a file of another format, as compressed text that other programs keep and do not read.

A .3dm file has it as user text of the document, a COMPAS document as an attribute: opened again, either is the same
model and not only its shape.
"""

from __future__ import annotations

import base64
import binascii
import zlib
from typing import TYPE_CHECKING, Any

from hookean.errors import InputError
from hookean.scene.text import parse

if TYPE_CHECKING:
    from hookean.scene.scene import Scene

KEY = "hookean-scene"
LARGEST = 512 * 2**20  # bytes of a scene in its canonical form


def packed(scene: Scene) -> str:
    """The scene as text: base64 of its canonical form, compressed."""
    return base64.b64encode(zlib.compress(scene.canonical.encode(), 6)).decode()


def unpacked(text: str, where: str) -> Any:
    """The scene that `packed` wrote, as plain values; InputError, at `where`, if the text is not one."""
    try:
        opened = zlib.decompressobj()
        data = opened.decompress(base64.b64decode(text, validate=True), LARGEST)
        whole = opened.eof
    except (binascii.Error, ValueError, zlib.error):
        whole = False
    if not whole:
        raise InputError(where, f"the scene in {KEY} is damaged; remove this text to open the file as drawn")
    return parse(data, where)
