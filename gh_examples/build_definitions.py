"""Writes the Grasshopper definitions of the examples, `definition.gh` beside each `definition.py`.

Run it from the project's root: `.venv/bin/python gh_examples/build_definitions.py [FIGURE ...]`. The same components
write the same definition. With `--xml`, `definition.ghx` is written instead, for people to read.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

from hookean_canvas.definitions.write import Definition

HERE = Path(__file__).parent


def figures() -> list[str]:
    """Folders that have a definition."""
    return sorted(path.parent.name for path in HERE.glob("*/definition.py"))


def definition(figure: str) -> Definition:
    """The definition of a figure, made by `definition()` in its module."""
    spec = importlib.util.spec_from_file_location(f"definition_of_{figure}", HERE / figure / "definition.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    made = module.definition()
    assert isinstance(made, Definition)
    return made


if __name__ == "__main__":
    words = sys.argv[1:]
    file = "definition.ghx" if "--xml" in words else "definition.gh"
    for name in [word for word in words if word != "--xml"] or figures():
        definition(name).save(HERE / name / file)
        print(f"{name}/{file}")
