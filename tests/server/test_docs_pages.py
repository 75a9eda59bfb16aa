"""The documentation at /docs/: media types, policy, caching, and nothing but its own files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from hookean_server.routes.built_files import KINDS
from serving import HANG

from .conftest import Served, problem
from .test_doors import Line

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
)
FILES = {
    "index.html": b"<!doctype html><title>hookean</title>",
    "http/index.html": b"<!doctype html><title>HTTP API</title>",
    "http/openapi.json": b"{}",
    "gallery/9.24-membrane/index.html": b"<!doctype html><title>9.24</title>",
    "gallery/9.24-membrane/picture.png": b"\x89PNG",
    "assets/javascripts/workers/search.a7633da7.min.js": b"export {};",
    "assets/stylesheets/main.css": b"p {}",
    "assets/icon.svg": b"<svg/>",
}


def built(folder: Path) -> Path:
    """A site as a build leaves it, with files beside it and in it that are not for browsers."""
    for name, content in FILES.items():
        (folder / "site" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "site" / name).write_bytes(content)
    (folder / "site" / ".git").mkdir()
    for name in ("secret.html", "site/sources.sha256", "site/.hidden.html", "site/.git/index.html", "site/run.py"):
        (folder / name).write_text("not for browsers")
    return folder / "site"


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    found = Served(site=str(built(tmp_path_factory.mktemp("docs"))), workers=1)
    yield found
    found.end()


@pytest.fixture
def browser(served: Served) -> Iterator[httpx.Client]:
    """Without a token."""
    with httpx.Client(base_url=served.url, timeout=HANG) as found:
        yield found


@pytest.fixture
def line(served: Served) -> Iterator[Line]:
    found = Line(served)
    yield found
    found.close()


@pytest.mark.parametrize("name", FILES)
def test_files_have_their_kind_and_are_closed_to_other_sites(browser: httpx.Client, name: str) -> None:
    """Media types as registered with IANA; the policy permits files of this origin, and icons as data."""
    answer = browser.get(f"/docs/{name}")
    assert answer.status_code == 200 and answer.content == FILES[name]
    assert answer.headers["content-type"].split(";")[0] == KINDS[name.rpartition(".")[2]]
    assert answer.headers["content-security-policy"] == POLICY
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["referrer-policy"] == "no-referrer"
    assert answer.headers["cross-origin-resource-policy"] == "same-origin"
    assert answer.headers["cross-origin-opener-policy"] == "same-origin"
    assert answer.headers["cache-control"] == "no-cache"


@pytest.mark.parametrize(
    ("path", "file"),
    [("", "index.html"), ("http/", "http/index.html"), ("gallery/9.24-membrane/", "gallery/9.24-membrane/index.html")],
)
def test_a_folder_is_its_page(browser: httpx.Client, path: str, file: str) -> None:
    """Its address without the slash leads to it, so that relative links of the page hold."""
    assert browser.get(f"/docs/{path}").content == FILES[file]
    moved = browser.get(f"/docs/{path}".rstrip("/"))
    assert moved.status_code == 307 and moved.headers["location"] == f"/docs/{path}"


@pytest.mark.parametrize("path", ["", "http/", "assets/stylesheets/main.css", "gallery/9.24-membrane/picture.png"])
def test_what_has_not_changed_is_not_sent_again(browser: httpx.Client, path: str) -> None:
    first = browser.get(f"/docs/{path}")
    again = browser.get(f"/docs/{path}", headers={"if-none-match": first.headers["etag"]})
    assert again.status_code == 304 and not again.content and again.headers["etag"] == first.headers["etag"]
    assert again.headers["content-security-policy"] == POLICY and again.headers["cache-control"] == "no-cache"
    assert browser.get(f"/docs/{path}", headers={"if-none-match": '"another"'}).status_code == 200
    head = browser.head(f"/docs/{path}")
    assert head.status_code == 200 and not head.content
    for name in ("content-length", "content-type", "etag", "cache-control", "content-security-policy"):
        assert head.headers[name] == first.headers[name]


@pytest.mark.parametrize(
    "path",
    [
        "../secret.html",
        "%2e%2e/secret.html",
        "%2e%2e/",
        "%2e%2e",
        "%2e%2e%2fsecret.html",
        "..%2fsecret.html",
        "..%5csecret.html",
        "http/../../secret.html",
        "http/%2e%2e/%2e%2e/secret.html",
        "http/../index.html",
        "http/..",
        "http/.",
        "./index.html",
        "//etc/passwd",
        "/etc/",
        "%2fetc%2fpasswd",
        "%00",
        "index.html%00.js",
        "index.html%0a",
        "index.html/",
        "http//",
        "C:/index.html",
        ".hidden.html",
        ".git/",
        ".git/index.html",
        "sources.sha256",
        "run.py",
        "assets",
        "assets/",
        "nothing/",
        "nothing.html",
        "http/index.html?%2e%2e",
    ],
)
def test_nothing_beside_the_site_is_served(line: Line, path: str) -> None:
    """Targets as they are sent, without what a client would tidy up."""
    for method in ("GET", "HEAD"):
        status = line.status(method, f"/docs/{path}")
        assert status == (200 if "?" in path else 404), (method, path, status)


def test_only_reading_is_allowed(browser: httpx.Client) -> None:
    for method in ("POST", "PUT", "PATCH", "DELETE"):
        assert browser.request(method, "/docs/").status_code in (401, 405), method


def test_a_site_that_was_not_built_says_how(tmp_path: Path) -> None:
    """One page that names `make site`; other addresses are not found."""
    served = Served(site=str(tmp_path / "none"), workers=1)
    try:
        with httpx.Client(base_url=served.url, timeout=HANG) as browser:
            answer = browser.get("/docs/")
            assert answer.status_code == 200 and answer.headers["content-type"].startswith("text/html")
            assert "<code>make site</code>" in answer.text
            assert answer.headers["content-security-policy"] == POLICY
            problem(browser.get("/docs/http/"), 404, "not-found")
    finally:
        served.end()
