"""A service, a browser and the page for the tests of this folder; whatever goes wrong in the page fails its test."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from .browser import FLAGS, LAPTOP, PHONE, Studio, context
from .service import Service

# the shell first: the same engine without windows, which takes a third less time
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
CHROMIUM = next(filter(None, map(shutil.which, BROWSERS)), None)
BUILT = Path(__file__).parents[2] / "server" / "hookean_server" / "page" / "index.html"

Opened = Callable[..., Studio]


@pytest.fixture(scope="session")
def chromium() -> str:
    if CHROMIUM is None:
        pytest.skip("there is no chromium on this machine")
    assert BUILT.is_file(), "the page is not built: python hatch_build.py"
    return CHROMIUM


@pytest.fixture(scope="session")
def launched(chromium: str) -> Iterator[tuple[Any, asyncio.AbstractEventLoop]]:
    """One browser for all tests, and the loop that Playwright keeps running in this thread."""
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    with playwright.sync_playwright() as driver:
        loop = asyncio.get_running_loop()
        found = driver.chromium.launch(executable_path=chromium, args=FLAGS)
        yield found, loop
        asyncio._set_running_loop(loop)
        found.close()


@pytest.fixture
def browser(launched: tuple[Any, asyncio.AbstractEventLoop]) -> Iterator[Any]:
    """The browser; tests of other files have the thread without the loop."""
    found, loop = launched
    asyncio._set_running_loop(loop)
    yield found
    asyncio._set_running_loop(None)


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory, chromium: str) -> Iterator[Service]:
    found = Service(tmp_path_factory.mktemp("service"))
    yield found
    found.end()


@pytest.fixture(scope="session")
def people(service: Service) -> dict[bool, Person]:
    """Those who are logged in at the service, with fingers (True) or with a mouse, once there are such."""
    return {}


class Person:
    """A browser of somebody who is logged in, with a page that one test leaves to the next: its process and the
    scripts it has compiled remain, which is a third of what opening a session takes."""

    def __init__(self, browser: Any, service: Service, fingers: bool) -> None:
        self.service, self.context = service, context(browser, has_touch=fingers)
        self.kept: Any = None
        first = Studio(self.context.new_page(), service)
        first.start()
        self.keep(first)

    def page(self) -> Any:
        """A page without what an earlier test kept in it."""
        self.context.clear_permissions()
        page, self.kept = self.kept or self._blank(), None
        page.evaluate("() => sessionStorage.clear()")
        stored = {"origin": self.service.url, "storageTypes": "local_storage,indexeddb"}
        self.context.new_cdp_session(page).send("Storage.clearDataForOrigin", stored)
        return page

    def keep(self, studio: Studio) -> None:
        """Leave a page to the next test, unless there is one, or it has listeners, routes or scripts of its own."""
        if self.kept or studio.called:
            studio.page.close()
            return
        studio.unwatch()
        self._leave(studio.page)
        studio.page.mouse.move(0, 0)
        self.kept = studio.page

    def _blank(self) -> Any:
        page = self.context.new_page()
        self._leave(page)
        return page

    def _leave(self, page: Any) -> None:
        page.goto(f"{self.service.url}/v1/health")  # of the same origin: another one has another process


def person(people: dict[bool, Person], browser: Any, service: Service, fingers: bool) -> Person:
    """One of those who are logged in."""
    if fingers not in people:
        people[fingers] = Person(browser, service, fingers)
    return people[fingers]


@pytest.fixture(scope="module")
def lasting(
    launched: tuple[Any, asyncio.AbstractEventLoop], service: Service, people: dict[bool, Person]
) -> Iterator[Studio]:
    """An empty page as on a laptop for all tests of a file, each of which takes the fixture `browser` too."""
    browser, loop = launched
    asyncio._set_running_loop(loop)
    someone = person(people, browser, service, fingers=False)
    studio = Studio(someone.page(), service)
    studio.page.set_viewport_size(LAPTOP)
    studio.watch()
    asyncio._set_running_loop(None)
    yield studio
    asyncio._set_running_loop(loop)
    wrong = studio.unexpected()
    someone.keep(studio)
    asyncio._set_running_loop(None)
    assert not wrong


@pytest.fixture
def open_studio(
    browser: Any, service: Service, people: dict[bool, Person], request: pytest.FixtureRequest, tmp_path: Path
) -> Iterator[Opened]:
    """Opens empty pages: of one who is logged in, with any eyes, or in a browser of its own, of another person."""
    opened: list[Studio] = []
    own: list[Any] = []

    def opening(
        size: dict[str, int] = LAPTOP, theme: str = "light", at: Service | None = None, alone: bool = False
    ) -> Studio:
        if alone or at:
            own.append(context(browser))
            page = own[-1].new_page()
        else:
            page = person(people, browser, service, fingers=size is PHONE).page()
        page.set_viewport_size(size)
        page.emulate_media(color_scheme=theme)
        made = Studio(page, at or service)
        made.watch()
        opened.append(made)
        return made

    yield opening
    failed = getattr(request.node, "failed", False)
    for number, studio in enumerate(opened):
        if failed or studio.unexpected():
            picture = tmp_path / f"{request.node.name}-{number}.png"
            studio.page.screenshot(path=picture)
            print(f"what was seen last: {picture}\n" + "\n".join(studio.unexpected()))
        [owner] = [one for one in people.values() if one.context == studio.page.context] or [None]
        if owner is None or failed or studio.unexpected():
            studio.page.close()
        else:
            owner.keep(studio)
    for made in own:
        made.close()
    for session in service.summaries():
        if session["playing"]:  # or it plays on beside the next test
            service.act(session["key"], "pause")
    wrong = [said for studio in opened for said in studio.unexpected()]
    if not failed:
        assert not wrong, wrong


@pytest.fixture
def tab(open_studio: Opened) -> Studio:
    """An empty page of one who is logged in, as on a laptop."""
    return open_studio()


@pytest.fixture
def studio(tab: Studio) -> Studio:
    """The start page."""
    tab.start()
    return tab


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
    report = yield
    if report.when == "call" and report.failed:
        item.failed = True  # type: ignore[attr-defined]
    return report
