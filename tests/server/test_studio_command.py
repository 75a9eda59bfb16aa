"""`hookean studio`: starts the service or joins it, makes a session of a file, opens a browser or tells the address."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest

from serving import CABLE, HANG, Home, wait_for

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

SHEET = "".join(f"v {i} {j} 0\n" for i in range(3) for j in range(3)) + "f 1 4 5 2\nf 2 5 6 3\nf 4 7 8 5\nf 5 8 9 6\n"


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """A state folder, with a browser that notes the address it is given."""
    found = Home(tmp_path / "state")
    browser = tmp_path / "browser.py"
    browser.write_text("import pathlib, sys\npathlib.Path(sys.argv[0]).with_name('seen').write_text(sys.argv[1])\n")
    found.environment["BROWSER"] = f"{sys.executable} {browser} %s"
    yield found
    found.end()


def begun(home: Home, *words: str) -> subprocess.Popen[str]:
    """`hookean studio`, which goes on where it serves itself."""
    command = [sys.executable, "-m", "hookean.cli", "studio", *words]
    process = subprocess.Popen(command, env=home.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    home.started.append(process)
    return process


@contextmanager
def lets_in(address: str) -> Iterator[httpx.Client]:
    """Somebody who opens the address: the token behind the # is that of the service."""
    [token] = parse_qs(urlsplit(address).fragment)["t"]
    base = f"http://{urlsplit(address).netloc}"
    with httpx.Client(base_url=base, headers={"authorization": f"Bearer {token}"}, timeout=HANG) as client:
        assert client.post("/v1/login").status_code == 204
        yield client


def test_a_file_is_shown_by_a_service_that_runs(home: Home, tmp_path: Path) -> None:
    """--no-browser says the address and nothing else; the file is a session with its name; opened again it is as it
    was left, and after it was changed another one."""
    home.serve()
    start = home.command("studio", "--no-browser")
    assert start.returncode == 0 and re.fullmatch(r"http://127\.0\.0\.1:\d+/#t=[\w.~-]+\n", start.stdout)
    file = tmp_path / "süd roof.obj"
    file.write_text(SHEET + "vn 0 0 1\n")
    shown = home.command("studio", str(file), "--no-browser")
    assert shown.returncode == 0 and "not taken of the file: normals" in shown.stderr, shown
    [key] = parse_qs(urlsplit(shown.stdout.strip()).fragment)["s"]
    with lets_in(shown.stdout.strip()) as client:
        session = client.get(f"/v1/sessions/{key}").json()
        assert (session["label"], session["particles"]) == ("süd roof.obj", 9)
        assert client.patch(f"/v1/sessions/{key}", json={"release": [0]}).status_code == 200
        again = home.command("studio", str(file), "--no-browser")
        assert again.stdout == shown.stdout and client.get(f"/v1/sessions/{key}").json()["revision"] == 1
        file.write_text(SHEET + "v 9 9 9\nl 9 10\n")
        other = home.command("studio", str(file), "--no-browser").stdout.strip()
        assert parse_qs(urlsplit(other).fragment)["s"] != [key]
        assert len(client.get("/v1/sessions").json()["sessions"]) == 2


def test_it_starts_the_service_and_opens_a_browser(home: Home, tmp_path: Path) -> None:
    """The browser gets the token, the terminal does not; Ctrl-C ends the service, which began here."""
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(CABLE))
    process = begun(home, str(file))
    seen = tmp_path / "seen"
    wait_for(lambda: seen.exists() and seen.read_text())
    with lets_in(seen.read_text()) as client:
        [session] = client.get("/v1/sessions").json()["sessions"]
        assert session["label"] == "scene.json" and f"s={session['key']}" in seen.read_text()
        token = client.headers["authorization"].split()[1]
    process.send_signal(signal.SIGINT)
    said, wrong = process.communicate(timeout=HANG)
    assert process.returncode == 0 and "hookean serves at" in said and "open in a browser" in said, (said, wrong)
    assert token not in said + wrong and not home.told


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("bad.obj", "v 0 0\n", "bad.obj: line 1: a vertex has three coordinates"),
        ("none.obj", None, "none.obj cannot be read"),
        ("a.stl", "solid", "give a .3dm, .obj, .json or .npz file"),
    ],
)
def test_a_file_that_cannot_be_opened_is_told_in_a_sentence(
    home: Home, tmp_path: Path, name: str, content: str | None, said: str
) -> None:
    """Exit code 2, no browser; a service that was started for it ends again."""
    file = tmp_path / name
    if content is not None:
        file.write_text(content)
    process = begun(home, str(file))
    _, wrong = process.communicate(timeout=HANG)
    assert process.returncode == 2 and said in wrong and "Traceback" not in wrong, wrong
    assert not (tmp_path / "seen").exists() and not home.serving()
