"""HTML for notebooks."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape


def summary(title: str, lines: Sequence[str], png: bytes = b"") -> str:
    """A title, lines of text, and a picture that lies in the page itself."""
    image = f'<img alt="" src="data:image/png;base64,{base64.b64encode(png).decode()}">' if png else ""
    return f"<div><b>{escape(title)}</b><pre>{escape(chr(10).join(lines))}</pre>{image}</div>"
