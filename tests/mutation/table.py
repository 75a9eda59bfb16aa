"""The modules whose mutants are run, with their tests: what table.toml lists, and every force."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
TABLE: dict[str, Any] = tomllib.loads(Path(__file__).with_name("table.toml").read_text(encoding="utf-8"))


def modules() -> dict[str, dict[str, Any]]:
    """How many mutants of each module are sampled, and the arguments of pytest that run its tests. A force that is not
    listed has the laws of its kind and the test file of its name."""
    forces = sorted((ROOT / "core" / "hookean" / "forces").glob("*.py"))
    return {**{f"forces/{path.name}": _usual(path.stem) for path in forces}, **TABLE["modules"]}


def _usual(kind: str) -> dict[str, Any]:
    own = f"tests/core/test_{kind}.py"
    tests = [*([own] if (ROOT / own).is_file() else []), "tests/laws/test_laws.py"]
    return {"mutants": 4, "tests": [*tests, "-k", kind]}
