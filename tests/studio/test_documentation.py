"""The documentation as the service shows it, in a browser: every page, narrow and wide, light and dark."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import hatch_build
import pytest

from serving import app
from soak import SOAK, sampled

from .browser import LAPTOP, PHONE, context
from .service import Service

pytestmark = pytest.mark.slow
pytest.importorskip("material", reason="what builds the site is not installed: pip install -e .[site]")


DECODED = "Promise.all([...document.images].map(image => { image.loading = 'eager'; return image.decode(); }))"
"""Waits for every picture of a page; fails where one is missing."""


@pytest.fixture(scope="module")
def pages() -> list[str]:
    """Addresses of all pages of the site, which is built where it is not."""
    if not hatch_build.site_is_built():
        hatch_build.build_site()
    found = sorted(path.parent.relative_to(hatch_build.SITE).as_posix() for path in hatch_build.SITE.rglob("*.html"))
    return [f"/docs/{path}/".replace("/./", "/") for path in found]


class Reader:
    """A browser's page, and everything that went wrong in it."""

    def __init__(self, browser: Any, service: Service, **options: Any) -> None:
        self.context, self.url = context(browser, **options), service.url
        self.own = f"{self.url}/docs"
        self.page = self.context.new_page()
        self.wrong: list[str] = []
        self.page.on("console", lambda message: self.wrong.append(f"{self.page.url}: {message.text}"))
        self.page.on("pageerror", lambda error: self.wrong.append(f"{self.page.url}: {error}"))
        self.page.on("request", lambda request: self._own(request.url))
        self.page.on(
            "response", lambda answer: answer.status < 400 or self.wrong.append(f"{answer.status} {answer.url}")
        )

    def _own(self, url: str) -> None:
        if not url.startswith((self.own, "data:")):
            self.wrong.append(f"{self.page.url} asks for {url}")

    def open(self, path: str) -> None:
        self.page.goto(self.url + path, wait_until="load")


@pytest.fixture
def reader(browser: Any, service: Service) -> Iterator[Any]:
    """Opens readers without a token; afterwards nothing may have gone wrong."""
    opened: list[Reader] = []

    def opening(**options: Any) -> Reader:
        opened.append(Reader(browser, service, **options))
        return opened[-1]

    yield opening
    for one in opened:
        one.context.close()
    assert [wrong for one in opened for wrong in one.wrong] == []


@pytest.mark.soak
@pytest.mark.parametrize(("size", "scheme"), sampled([(PHONE, "dark"), (LAPTOP, "light")], 2))
def test_every_page_fits_and_loads_only_its_own(reader: Any, pages: list[str], size: Any, scheme: str) -> None:
    """No page is wider than the window; nothing on the console, such as a refusal by the policy; pictures are
    there. One page in sixteen, other ones at each size; all in `make soak`."""
    shown = reader(viewport=size, color_scheme=scheme)
    for path in pages if SOAK else pages[7 * (size is PHONE) :: 16]:
        shown.open(path)
        assert shown.page.evaluate("document.documentElement.scrollWidth") <= size["width"], path
        shown.page.evaluate(DECODED)


@pytest.mark.soak
def test_the_search_finds_a_page(reader: Any, pages: list[str]) -> None:
    shown = reader()
    shown.open("/docs/tutorials/cable/")
    shown.page.get_by_placeholder("Search").click()
    shown.page.keyboard.type("soap film")
    shown.page.locator(".md-search-result__link[href*='how-to/soap-film/']").first.wait_for()
    shown.page.locator(".md-search-result__link[href*='how-to/soap-film/']").first.click()
    shown.page.wait_for_url(re.compile("/docs/how-to/soap-film/"))


@pytest.mark.soak
def test_the_reference_lists_every_operation_and_tries_one(reader: Any, service: Service, pages: list[str]) -> None:
    """In the colours chosen on the other pages; with the token a request to this service is answered."""
    shown = reader(color_scheme="light")
    shown.open("/docs/")
    shown.page.locator("label[title='Dark']").click()
    shown.open("/docs/http/")
    operations = shown.page.locator(".opblock")
    operations.first.wait_for()
    assert operations.count() == sum(len(item) for item in app().openapi()["paths"].values())
    assert shown.page.evaluate("document.documentElement.classList.contains('dark-mode')")
    shown.own = service.url
    shown.page.locator("button.authorize").click()
    dialog = shown.page.locator(".auth-container", has_text=re.compile(r"^token"))
    dialog.locator("input").fill(service.token)
    dialog.get_by_role("button", name="Apply credentials").click()
    shown.page.locator(".btn-done").first.click()
    forces = shown.page.locator(".opblock", has=shown.page.locator("[data-path='/v1/forces']"))
    forces.locator(".opblock-summary-control").click()
    forces.get_by_role("button", name="Try it out").click()
    forces.get_by_role("button", name="Execute").click()
    assert forces.locator(".live-responses-table tbody .response-col_status").first.inner_text().startswith("200")
