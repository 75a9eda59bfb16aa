"""The page's files: of the right kind, guarded, kept by browsers while they stay the same, and nothing beside them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from hookean_server.routes.built_files import KINDS
from serving import HANG

from .conftest import Served, problem

HTML = {"accept": "text/html,application/xhtml+xml,*/*;q=0.8"}
POLICY = (
    "default-src 'self'; connect-src 'self' ws://127.0.0.1:* ws://localhost:*; img-src 'self' data: blob:; "
    "frame-ancestors 'none'; base-uri 'none'"
)
FILES = {
    "index.html": b"<!doctype html><title>hookean</title>",
    "icon.svg": b"<svg/>",
    "assets/app-Ab_3-x.js": b"export {};",
    "assets/app-Ab_3-x.css": b"p {}",
    "assets/font.woff2": b"wOF2",
    "assets/picture.png": b"\x89PNG",
    "assets/data.json": b"{}",
}


def built(folder: Path) -> Path:
    """A page as a build leaves it, with a file beside it that is none of its."""
    (folder / "page" / "assets" / "deeper").mkdir(parents=True)
    for name, content in FILES.items():
        (folder / "page" / name).write_bytes(content)
    for name in ("secret.js", "page/notes.txt", "page/.hidden.js", "page/assets/deeper/app.js", "page/assets/run.py"):
        (folder / name).write_text("not for browsers")
    return folder / "page"


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    found = Served(page=str(built(tmp_path_factory.mktemp("page"))), workers=1)
    yield found
    found.end()


@pytest.fixture
def browser(served: Served) -> Iterator[httpx.Client]:
    """Without a token."""
    with httpx.Client(base_url=served.url, timeout=HANG) as found:
        yield found


def test_a_browser_gets_the_page_and_a_program_the_functions(browser: httpx.Client) -> None:
    page = browser.get("/", headers=HTML)
    assert page.status_code == 200 and page.content == FILES["index.html"]
    assert page.headers["content-type"] == "text/html; charset=utf-8" and page.headers["vary"] == "Accept"
    listed = browser.get("/", headers={"accept": "*/*"})
    assert listed.headers["vary"] == "Accept" and "cable" in {f["Uri"].lstrip("/") for f in listed.json()}
    assert "content-security-policy" not in listed.headers


@pytest.mark.parametrize("name", FILES)
def test_files_have_their_kind_and_are_closed_to_others(browser: httpx.Client, name: str) -> None:
    """Media types as registered with IANA; the policy lets nothing in from elsewhere and no script in the page."""
    answer = browser.get(f"/page/{name}")
    kind = KINDS[name.rpartition(".")[2]]
    assert answer.status_code == 200 and answer.content == FILES[name]
    assert answer.headers["content-type"].split(";")[0] == kind
    assert answer.headers["content-security-policy"] == POLICY
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["referrer-policy"] == "no-referrer"
    hashed = name.startswith("assets/")
    assert answer.headers["cache-control"] == ("public, max-age=31536000, immutable" if hashed else "no-cache")


def test_the_kinds_are_those_that_browsers_ask_for() -> None:
    """HTML standard: a module script is refused unless its media type is a JavaScript one, a style unless text/css."""
    assert KINDS["js"] == "text/javascript" and KINDS["css"] == "text/css" and KINDS["html"] == "text/html"
    assert KINDS["svg"] == "image/svg+xml" and KINDS["woff2"] == "font/woff2" and KINDS["png"] == "image/png"


@pytest.mark.parametrize("path", ["/", "/page/index.html", "/page/assets/app-Ab_3-x.js"])
def test_what_has_not_changed_is_not_sent_again(browser: httpx.Client, path: str) -> None:
    first = browser.get(path, headers=HTML)
    again = browser.get(path, headers={**HTML, "if-none-match": first.headers["etag"]})
    assert again.status_code == 304 and not again.content and again.headers["etag"] == first.headers["etag"]
    assert again.headers["cache-control"] == first.headers["cache-control"]
    assert again.headers["content-security-policy"] == POLICY
    assert browser.get(path, headers={**HTML, "if-none-match": '"another"'}).status_code == 200
    head = browser.head(path, headers=HTML)
    assert head.status_code == 200 and not head.content
    for name in ("content-length", "content-type", "etag", "cache-control", "content-security-policy"):
        assert head.headers[name] == first.headers[name]


@pytest.mark.parametrize(
    "path",
    [
        "",
        ".",
        "../secret.js",
        "..%2fsecret.js",
        "%2e%2e/secret.js",
        "%2e%2e%2fsecret.js",
        "..%5csecret.js",
        "assets/../index.html",
        "assets/..%2f..%2fsecret.js",
        "assets/../../secret.js",
        "//etc/passwd",
        "%2fetc%2fpasswd",
        "notes.txt",
        ".hidden.js",
        "assets",
        "assets/",
        "assets/run.py",
        "assets/deeper/app.js",
        "index.html%00.js",
        "index.html/",
        "none.js",
    ],
)
def test_nothing_else_is_served(served: Served, path: str) -> None:
    """Sent as it stands, for clients tidy addresses up."""
    import http.client

    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=HANG)
    try:
        connection.request("GET", f"/page/{path}")
        answer = connection.getresponse()
        said = answer.read()
    finally:
        connection.close()
    assert answer.status in (401, 404) and b"not for browsers" not in said and b"doctype" not in said, said


def test_the_page_is_read_only(browser: httpx.Client) -> None:
    for method in ("POST", "PUT", "PATCH", "DELETE"):
        assert browser.request(method, "/page/index.html").status_code in (401, 405)


def test_a_page_that_was_not_built_says_how(tmp_path: Path) -> None:
    """As in a checkout that was never installed, where the folder is not even there."""
    served = Served(page=str(tmp_path / "none"), workers=1)
    try:
        with httpx.Client(base_url=served.url, timeout=HANG) as browser:
            page = browser.get("/", headers=HTML)
            assert page.status_code == 200 and page.headers["content-type"].startswith("text/html")
            assert "python hatch_build.py" in page.text and "install" in page.text and "<script" not in page.text
            assert page.headers["cache-control"] == "no-cache"
            assert page.headers["content-security-policy"] == POLICY
            problem(browser.get("/page/index.html"), 404, "not-found")
            assert browser.get("/").json()
    finally:
        served.end()
