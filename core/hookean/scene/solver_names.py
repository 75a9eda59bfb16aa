"""What `settings.solver` may be: the names of the files in `solvers/`, so that a new solver is one new file."""

from __future__ import annotations

from pathlib import Path
from pkgutil import iter_modules

_files = [found.name for found in iter_modules([str(Path(__file__).parents[1] / "solvers")])]
SOLVERS: tuple[str, ...] = ("auto", *(name for name in _files if name not in ("auto", "base") and name[0] != "_"))
