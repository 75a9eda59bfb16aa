"""Saved simulations (.npz of `Simulation.save`), read from bytes of anybody."""

from __future__ import annotations

import io
import zipfile

from hookean.errors import InputError
from hookean.running.simulation import Simulation

BEGINS = b"PK\x03\x04"


def read(data: bytes, where: str = "") -> Simulation:
    """The simulation in the bytes of a file; InputError, at `where`, if it is not one. Compressed files are refused:
    `save` does not compress, so nothing read is larger than the file."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            plain = all(part.compress_type == zipfile.ZIP_STORED for part in file.infolist())
        if not plain:
            raise InputError(where, "compressed; save the simulation with Simulation.save, which does not compress")
        return Simulation.load(io.BytesIO(data))
    except InputError as error:
        raise InputError(where, error.sentence) from None
    except (zipfile.BadZipFile, MemoryError, OSError, NotImplementedError):
        raise InputError(where, "not a saved simulation; give a file written by Simulation.save") from None
