"""Parts of packages load when they are first used, and are then what they are without that."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

from hookean.linear.put_off import put_off

HANG = 60.0


def test_a_part_runs_when_something_of_it_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once. A part that is loaded stays as it is; one that does not exist is skipped."""
    folder = tmp_path / "boxes"
    folder.mkdir()
    (folder / "__init__.py").write_text("ran = []\n")
    for part in ("early", "late"):
        (folder / f"{part}.py").write_text(f"import boxes\nboxes.ran.append({part!r})\nvalue = 7\n")
    monkeypatch.syspath_prepend(tmp_path)
    boxes = importlib.import_module("boxes")
    early = importlib.import_module("boxes.early")
    try:
        put_off("boxes", ("early", "late", "absent"))
        assert boxes.ran == ["early"] and sys.modules["boxes.early"] is early
        assert not hasattr(boxes, "absent")
        assert boxes.late.value == 7 and boxes.ran == ["early", "late"]
        assert importlib.import_module("boxes.late") is boxes.late and boxes.ran == ["early", "late"]
    finally:
        for name in ("boxes", "boxes.early", "boxes.late"):
            sys.modules.pop(name, None)


@pytest.mark.slow
def test_sparse_matrices_load_without_the_compiler_of_fortran() -> None:
    """And numpy.f2py is there for those who use it."""
    code = (
        "import sys, hookean.linear, numpy, scipy.sparse\n"
        "assert 'numpy.f2py.crackfortran' not in sys.modules\n"
        "assert numpy.f2py.get_include() and 'numpy.f2py.crackfortran' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=HANG)
