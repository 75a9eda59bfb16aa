"""`hookean forces`: every force with its formula and columns."""

from __future__ import annotations


def catalogue() -> str:
    """The catalogue as text: for each force its kind, formula, first sentence, and a line for each column."""
    from hookean.forces import KINDS

    lines: list[str] = []
    for kind, cls in KINDS.items():
        first = " ".join((cls.__doc__ or "").split("\n\n")[0].split())
        lines += [f"{kind}   {cls.formula}", f"    {first}"]
        for name, column in cls.model_fields.items():
            if name in ("kind", "name"):
                continue
            default = "required" if column.is_required() else f"default {column.default}"
            if not column.is_required() and column.default is None:
                default = "optional"
            lines.append(f"    {name:<16} {column.description or ''} ({' '.join(default.split())})")
        lines.append("")
    return "\n".join(lines).rstrip()
