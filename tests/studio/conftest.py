"""A service, a browser and the page for the tests of this folder; whatever goes wrong in the page fails its test."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from .browser import FLAGS, Studio, context
from .service import Service

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
BUILT = Path(__file__).parents[2] / "server" / "hookean_server" / "page" / "index.html"

Opened = Callable[..., Studio]


@pytest.fixture(scope="session")
def chromium() -> str:
    if CHROMIUM is None:
        pytest.skip("there is no chromium on this machine")
    assert BUILT.is_file(), "the page is not built: python hatch_build.py"
    return CHROMIUM


@pytest.fixture(scope="module")  # while it is open, Playwright keeps the loop of this thread from tests of other files
def browser(chromium: str) -> Iterator[Any]:
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=chromium, args=FLAGS)
        yield found
        found.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory, chromium: str) -> Iterator[Service]:
    found = Service(tmp_path_factory.mktemp("service"))
    yield found
    found.end()


@pytest.fixture
def open_studio(browser: Any, service: Service, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Opened]:
    """Opens the page in browsers of different people, or of one with other eyes."""
    opened: list[Studio] = []

    def opening(at: Service = service, login: bool = True, **options: Any) -> Studio:
        made = Studio(context(browser, **options).new_page(), at)
        made.watch()
        opened.append(made)
        if login:
            made.start()
        return made

    yield opening
    failed = getattr(request.node, "failed", False)
    for number, studio in enumerate(opened):
        if failed or studio.unexpected():
            picture = tmp_path / f"{request.node.name}-{number}.png"
            studio.page.screenshot(path=picture)
            print(f"what was seen last: {picture}\n" + "\n".join(studio.unexpected()))
        studio.page.context.close()
    wrong = [said for studio in opened for said in studio.unexpected()]
    if not failed:
        assert not wrong, wrong


@pytest.fixture
def studio(open_studio: Opened) -> Studio:
    """The start page, logged in, as on a laptop."""
    return open_studio()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
    report = yield
    if report.when == "call" and report.failed:
        item.failed = True  # type: ignore[attr-defined]
    return report
