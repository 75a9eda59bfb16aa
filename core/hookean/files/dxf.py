"""DXF files, for CAD: documents with layers, in the units of what is drawn. The same content gives the same bytes."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hookean.atomic_write import put
from hookean.files.optional import needed

UNITS = {"mm": 4, "cm": 5, "dm": 14, "m": 6, "km": 7, "in": 1, "ft": 2, "yd": 10}
"""Codes of $INSUNITS by units of length."""


def document(name: str, unit: str, layers: dict[str, int]) -> Any:
    """An empty document with these layers and their colours (AutoCAD's numbers), for the file `name`."""
    ezdxf = needed("ezdxf", "exchange", name)
    with _fixed(ezdxf):
        made = ezdxf.new("R2010", setup=False)
    made.header["$INSUNITS"] = UNITS.get(unit, 0)
    for layer, colour in layers.items():
        made.layers.add(layer, color=colour)
    return made


def write(made: Any, target: Path) -> None:
    """Write a document, replaced in one step or not at all."""
    ezdxf = needed("ezdxf", "exchange", target.name)
    text = io.StringIO()
    with _fixed(ezdxf):
        made.write(text)
    put(target, text.getvalue().encode(made.output_encoding), lambda back: None)


@contextmanager
def _fixed(ezdxf: Any) -> Iterator[None]:
    """Without dates and random numbers."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before
