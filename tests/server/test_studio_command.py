"""`hookean studio`: starts the service or joins it, makes a session of a file, opens a browser or tells the address."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from html import unescape
from pathlib import Path
from urllib.parse import parse_qs, unquote, urlsplit

import httpx
import numpy as np
import pytest

import forking
from hookean import Scene, Simulation
from hookean.files import project
from hookean_server.http.packing import unpacked
from hookean_server.lifecycle.studio import LONGEST_VIEW, view_in
from serving import CABLE, HANG, Home, wait_for

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

SHEET = "".join(f"v {i} {j} 0\n" for i in range(3) for j in range(3)) + "f 1 4 5 2\nf 2 5 6 3\nf 4 7 8 5\nf 5 8 9 6\n"


def test_a_saved_model_leads_to_the_view_it_was_saved_with() -> None:
    """The address has the view of the file, whatever is in it, with sets of particles as differences: half of 60,000
    particles, chosen at random, fit into it. Of other files it has none, and none of a view that is too long, with a
    sentence."""

    def told(view: dict[str, object]) -> tuple[object, str]:
        found, note = view_in(project.write(project.Project(simulation, view)))
        return found and json.loads(unpacked(parse_qs(f"s=a{found}")["v"][0], "view")), note

    simulation, random = Simulation(Scene.read(CABLE)), np.random.default_rng(7)
    view = {"eye": [0.5, 1.0], "colouring": "strain", "layers": 3}
    steps = {"groups": {"rim & seam": [5, -3, 7]}, "marked": [4]}
    assert told({**view, "groups": {"rim & seam": [5, 2, 9]}, "marked": [4]}) == ({**view, "steps": steps}, "")
    assert told({**view, "groups": "all", "marked": ["x"]}) == ({**view, "groups": "all", "marked": ["x"]}, "")
    half = np.flatnonzero(random.random(60_000) < 0.5).tolist()
    assert told({"groups": {"half": half}})[0]
    assert told({}) == ("", "")
    noise = random.integers(0, 10**9, LONGEST_VIEW // 4).tolist()  # about 4 bytes each, compressed
    empty, note = told({"marked": noise})
    assert empty == "" and "too long for an address" in note
    assert view_in(b"v 0 0 0") == view_in(b"PK\x03\x04 damaged") == ("", "")


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
    process: subprocess.Popen[str] = home.run(forking.COMMAND, "studio", *words)
    return process


def led(seen: str) -> str:
    """Where the file leads that a browser was given."""
    page = Path(unquote(urlsplit(seen).path)).read_text()
    [address] = re.findall(r'content="0; url=([^"]*)"', page)
    return unescape(address)


@contextmanager
def lets_in(address: str) -> Iterator[httpx.Client]:
    """Somebody who opens the address: the token or code behind the # gets a cookie, as the page does."""
    [token] = parse_qs(urlsplit(address).fragment)["t"]
    base = f"http://{urlsplit(address).netloc}"
    with httpx.Client(base_url=base, timeout=HANG) as client:
        login = client.post("/v1/login", headers={"authorization": f"Bearer {token}"})
        assert login.status_code == 204
        client.headers["cookie"] = login.headers["set-cookie"].split(";")[0]
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
    assert shown.returncode == 0 and "not read from the file: normals" in shown.stderr, shown
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
    file = tmp_path / "empty.3dm"
    file.write_bytes(b"")
    refused = home.command("studio", str(file), "--no-browser")
    assert refused.returncode == 2 and not refused.stdout
    assert re.fullmatch(
        r"hookean: empty\.3dm: the file is empty .*; save it again .* or choose another file\n", refused.stderr
    )


def test_it_starts_the_service_and_opens_a_browser(home: Home, tmp_path: Path) -> None:
    """The browser gets a file that leads it to the page with a code; the token stays where it was; once the code was
    used the file is gone; Ctrl-C ends the service, which began here."""
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(CABLE))
    process = begun(home, str(file))
    seen = tmp_path / "seen"
    wait_for(lambda: seen.exists() and seen.read_text())
    given, token = seen.read_text(), home.told["token"]
    door = Path(unquote(urlsplit(given).path))
    assert given.startswith("file://") and door.stat().st_mode & 0o777 == 0o600 and door.parent == home.folder
    address = led(given)
    assert token not in given + door.read_text()
    with lets_in(address) as client:
        [session] = client.get("/v1/sessions").json()["sessions"]
        assert session["label"] == "scene.json" and f"s={session['key']}" in address
        [code] = parse_qs(urlsplit(address).fragment)["t"]
        assert client.post("/v1/login", headers={"authorization": f"Bearer {code}"}).status_code == 401
    wait_for(lambda: not door.exists())
    process.send_signal(signal.SIGINT)
    said, wrong = process.communicate(timeout=HANG)
    assert process.returncode == 0 and "hookean serves at" in said and "open in a browser" in said, (said, wrong)
    assert token not in said + wrong and code not in said + wrong and not home.told


@pytest.mark.soak
def test_a_second_user_finds_nothing_in_the_list_of_processes() -> None:
    """`nobody` reads the arguments of all processes, over and over, while `hookean studio` opens a browser and for as
    long as it is open, and tries to read what is named there."""
    if os.getuid() != 0 or not Path("/proc/self/cmdline").exists():
        pytest.skip("takes root, who can be another user, and /proc")
    folder = Path(tempfile.mkdtemp(prefix="hookean-studio-"))
    folder.chmod(0o755)
    home = Home(folder / "state", fresh=True)  # with the arguments of its own
    browser = folder / "browser.py"
    browser.write_text(
        "import pathlib, sys, time\npathlib.Path(sys.argv[0]).with_name('seen').write_text(sys.argv[1])\n"
        "while not pathlib.Path(sys.argv[0]).with_name('enough').exists(): time.sleep(0.05)\n"
    )
    home.environment["BROWSER"] = f"{sys.executable} {browser} %s &"  # as a browser that goes on by itself
    poll = (
        "import glob, os, sys\nos.setgroups([]); os.setgid(65534); os.setuid(65534)\nlines, read = set(), set()\n"
        "print('polling', flush=True)\n"
        f"while not os.path.exists({str(folder / 'enough')!r}):\n"
        "    for path in glob.glob('/proc/[0-9]*/cmdline'):\n"
        "        try:\n            line = open(path, 'rb').read().replace(b'\\0', b' ').decode('utf-8', 'replace')\n"
        "        except OSError:\n            continue\n"
        "        lines.add(line)\n"
        f"        for word in line.split():\n            if {str(folder)!r} in word:\n"
        "                try:\n                    read.add(open(word.replace('file://', '')).read())\n"
        "                except OSError:\n                    pass\n"
        "print('\\n'.join(sorted(lines)))\nprint('FILES', sorted(read))\n"
    )
    try:
        home.serve()
        token = home.told["token"]
        with subprocess.Popen([sys.executable, "-c", poll], stdout=subprocess.PIPE, text=True) as nobody:
            assert nobody.stdout is not None and nobody.stdout.readline() == "polling\n"
            process = begun(home)
            wait_for(lambda: (folder / "seen").exists() and (folder / "seen").read_text())
            address = led((folder / "seen").read_text())
            [code] = parse_qs(urlsplit(address).fragment)["t"]
            with lets_in(address) as page:
                assert page.get("/v1/sessions").status_code == 200
            assert process.wait(HANG) == 0  # the browser goes on, with the pipes that it was given
            (folder / "enough").write_text("")
            found = nobody.communicate(timeout=HANG)[0]
        assert "open-" in found, "the poller saw the browser's arguments"
        assert token not in found and code not in found
        assert str(home.told["proof"]) not in found
    finally:
        (folder / "enough").write_text("")
        home.end()
        shutil.rmtree(folder)


def test_files_of_commands_that_were_killed_are_removed(home: Home) -> None:
    """Their codes are worth nothing after a minute; the next command removes what is older than ten."""
    home.folder.mkdir(mode=0o700)
    old, young = home.folder / "open-old.html", home.folder / "open-young.html"
    for path in (old, young):
        path.write_text("")
    os.utime(old, (1, 1))
    home.serve()
    process = begun(home)
    seen = home.folder.parent / "seen"
    wait_for(lambda: seen.exists() and seen.read_text())
    with lets_in(led(seen.read_text())):
        process.communicate(timeout=HANG)
    assert not old.exists() and young.exists() and process.returncode == 0


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("bad.obj", "v 0 0\n", "bad.obj: line 1: a vertex needs three coordinates"),
        ("none.obj", None, "none.obj cannot be read"),
        ("a.stl", "solid", "give a .3dm, .obj, .json, .npz or .hookean file"),
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
