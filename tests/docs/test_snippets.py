"""The Python of the tutorials and how-to pages runs as printed, and prints what is shown below it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from serving import Home

from . import snippets

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, in which the page runs."""
    (tmp_path / "page").mkdir()
    monkeypatch.chdir(tmp_path / "page")
    return tmp_path


@pytest.fixture
def service(folder: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Iterator[None]:
    """A service of this test's own for a page that connects to one."""
    home = Home(folder / "state")
    (folder / "state").mkdir(mode=0o700)
    monkeypatch.setenv("HOOKEAN_STATE", str(folder / "state"))
    monkeypatch.delenv("HOOKEAN_TOKEN", raising=False)
    try:
        if "hookean_client" in request.getfixturevalue("page").read_text("utf-8"):
            home.serve()
        yield
    finally:
        home.end()


@pytest.mark.slow
@pytest.mark.parametrize("page", snippets.PAGES, ids=lambda page: page.stem)
def test_a_page_prints_what_it_shows(page: Path, service: None) -> None:
    """The same words; numbers agree to three units of the last digit shown, which leaves room for other machines'
    rounding where a run ends within its tolerance (1e-6), and for a zero's sign."""
    for (_, shown), printed in zip(snippets.blocks(page), snippets.run(page), strict=True):
        assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", shown).split(), (printed, shown)
        for number, wanted in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
            digits = len(wanted.partition(".")[2])
            assert float(number) == pytest.approx(float(wanted), abs=3 * 10.0**-digits if digits else 0), printed


@pytest.mark.parametrize("page", snippets.PAGES, ids=lambda page: page.stem)
def test_a_picture_is_made_by_the_code_of_its_page(page: Path) -> None:
    """Every picture shown is saved by a block under its name, and is there."""
    code = "".join(code for code, _ in snippets.blocks(page))
    for name in re.findall(r"!\[[^\]]+\]\(pictures/([^)]+)\)", page.read_text("utf-8")):
        assert f'"{name}"' in code and (page.parent / "pictures" / name).is_file(), name


@pytest.mark.parametrize("page", snippets.PAGES, ids=lambda page: page.stem)
def test_a_screen_is_taken_by_a_task_of_the_studio(page: Path) -> None:
    """Every picture of the studio is of a step that the tests drive, and is there."""
    driven = Path(__file__).parents[1] / "studio"
    steps = "".join((driven / name).read_text("utf-8") for name in ("tasks.py", "drawing.py"))
    for name in re.findall(r"!\[[^\]]+\]\(screens/([^)]+)\.png\)", page.read_text("utf-8")):
        assert f'see("{name}")' in steps and (page.parent / "screens" / f"{name}.png").is_file(), name


def test_there_are_pages() -> None:
    assert {"start", "cable", "membrane-roof", "live-session"} <= {page.stem for page in snippets.PAGES}
    by_hand = {"index", "draw-a-net", "read-in-the-studio"}  # of what is done in the page
    assert all(len(snippets.blocks(page)) >= 2 for page in snippets.PAGES if page.stem not in by_hand)
