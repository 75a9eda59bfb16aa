"""The frames' format for the page: `python -m hookean_server.sessions.wire_typescript > studio/src/wire.ts`."""

from __future__ import annotations

import re
import struct

from hookean_server.sessions import wire

FIELDS = (
    "magic", "version", "size", "flags", "number", "revision", "iteration", "time", "residual", "particles", "springs",
    "status", "playing", "zero", "kinetic",
)  # fmt: skip
"""The fields of `wire.HEADER`, by its order."""

_READ = {
    "B": "view.getUint8({})",
    "H": "view.getUint16({}, true)",
    "I": "view.getUint32({}, true)",
    "Q": "Number(view.getBigUint64({}, true))",
    "f": "view.getFloat32({}, true)",
    "d": "view.getFloat64({}, true)",
    "4s": "String.fromCharCode(...new Uint8Array(view.buffer, view.byteOffset + {}, 4))",
}


def typescript() -> str:
    """A module with the constants of the format, the type of a header and the function that reads one."""
    codes = re.findall(r"4s|[BHIQfd]", wire.HEADER.format)
    offsets = [struct.calcsize("<" + "".join(codes[:i])) for i in range(len(codes))]
    fields = list(zip(FIELDS, codes, offsets, strict=True))
    lines = [
        "// Written by hookean_server.sessions.wire_typescript from wire.py.",
        f'export const MAGIC = "{wire.MAGIC.decode()}";',
        f"export const VERSION = {wire.VERSION};",
        f"export const SIZE = {wire.SIZE};",
        f"export const POSITIONS = {wire.POSITIONS};",
        f"export const SCALARS = {wire.SCALARS};",
        f"export const REACTIONS = {wire.REACTIONS};",
        f"export const CHANGES = {wire.CHANGES};",
        "export const STATUSES = [",
        *(f'  "{status}",' for status in wire.STATUSES),
        "] as const;",
        "",
        "export type Status = (typeof STATUSES)[number];",
        "",
        "/** The first bytes of a frame, as numbers. */",
        "export interface Header {",
        *(f"  {name}: {'string' if code == '4s' else 'number'};" for name, code, _ in fields),
        "}",
        "",
        "/** The header of the frame in `view`, which holds at least SIZE bytes. */",
        "export function header(view: DataView): Header {",
        "  return {",
        *(f"    {name}: {_READ[code].format(offset)}," for name, code, offset in fields),
        "  };",
        "}",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(typescript(), end="")
