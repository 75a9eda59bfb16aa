"""The modules whose mutants are run, with their tests: what table.toml lists, and every force."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FORCES = ROOT / "core" / "hookean" / "forces"
TABLE: dict[str, Any] = tomllib.loads(Path(__file__).with_name("table.toml").read_text(encoding="utf-8"))


def modules() -> dict[str, dict[str, Any]]:
    """How many mutants of each module are sampled, and the arguments of pytest that run its tests. A force that is not
    listed has the laws of its kind and the test file of its name; a file that forces share has those of the forces."""
    return {**{f"forces/{path.name}": _usual(path.stem) for path in sorted(FORCES.glob("*.py"))}, **TABLE["modules"]}


def _usual(name: str) -> dict[str, Any]:
    kinds = [name] if _own(name).is_file() else [kind for kind in _users(name) if _own(kind).is_file()]
    tests = [*(_own(kind).relative_to(ROOT).as_posix() for kind in kinds), "tests/laws/test_laws.py"]
    return {"mutants": 4, "tests": [*tests, "-k", " or ".join(kinds or [name])]}


def _own(kind: str) -> Path:
    return ROOT / "tests" / "core" / f"test_{kind}.py"


def _users(name: str) -> list[str]:
    """The force files that import one of them."""
    line = f"from hookean.forces.{name} import "
    return [path.stem for path in sorted(FORCES.glob("*.py")) if line in path.read_text(encoding="utf-8")]
