"""Each line of the page of promises names existing tests."""

from __future__ import annotations

import ast
import re
from pathlib import Path

TESTS = Path(__file__).parents[1]
PAGE = (TESTS.parent / "docs" / "service.md").read_text("utf-8").partition("\n## What is promised\n")[2]


def test_every_promise_names_tests_that_there_are() -> None:
    """In the last cell of a line: `file.py::name`, further ones of the same file as `::name`."""
    lines = [
        line for line in PAGE.splitlines() if line.startswith("|") and "---" not in line and "| test |" not in line
    ]
    assert len(lines) >= 14
    for line in lines:
        named = re.findall(r"`([\w/]*(?:\.py)?)::(\w+)`", line.rstrip(" |").rpartition("|")[2])
        assert named, line
        file = ""
        for path, name in named:
            file = path or file
            [found] = TESTS.rglob(file)
            functions = {
                node.name for node in ast.walk(ast.parse(found.read_text("utf-8"))) if isinstance(node, ast.FunctionDef)
            }
            assert name in functions, (file, name)
