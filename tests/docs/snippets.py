"""The Python of the documentation's pages: its blocks in their order, each with the output printed below it.

By hand, to write the output of a page again: `cd tests && python -m docs.snippets ../docs/tutorials/cable.md`; its
pictures go to the folder `pictures` beside it.
"""

from __future__ import annotations

import contextlib
import io
import re
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(
    page
    for page in [
        DOCS / "start.md",
        DOCS / "analysis.md",
        DOCS / "design.md",
        *DOCS.glob("tutorials/*.md"),
        *DOCS.glob("how-to/*.md"),
    ]
)
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\s*^```text\n(.*?)^```)?", re.S | re.M)


def blocks(page: Path) -> list[tuple[str, str]]:
    """Code and output of each block; the output is empty where the page shows none."""
    return [(m[1], m[2] or "") for m in BLOCK.finditer(page.read_text("utf-8"))]


def run(page: Path) -> list[str]:
    """What each block prints, run one after another in the present folder with the names of those before."""
    names: dict[str, object] = {"__name__": "__main__"}
    printed = []
    for number, (code, _) in enumerate(blocks(page)):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(code, f"{page.name}, block {number}", "exec"), names)
        printed.append(out.getvalue())
    return printed


def write(page: Path) -> None:
    """Write the output of a page's blocks below them, and its pictures beside it."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        printed, text = iter(run(page)), page.read_text("utf-8")

        def shown(match: re.Match[str]) -> str:
            start, out = match.start(), next(printed)
            return (
                match[0] if match[2] is None else text[start : match.start(2)] + out + text[match.end(2) : match.end()]
            )

        page.write_text(BLOCK.sub(shown, text), "utf-8")
        for name in re.findall(r"\(pictures/([^)]+)\)", text):
            (page.parent / "pictures").mkdir(exist_ok=True)
            shutil.copy(Path(folder) / name, page.parent / "pictures" / name)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        write(Path(name).resolve())
