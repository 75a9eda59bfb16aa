"""A server is recognised by proof: what answers at its address shows, on the same connection, that it knows the key in
a file that only its user could have written; a token is sent after that or not at all."""

from __future__ import annotations

import hashlib
import hmac
import http.client
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

import hookean_client.transport
from hookean_client import finding
from hookean_server.lifecycle import discovery
from hookean_server.lifecycle.discovery import Distrusted, Found, ask, check, find, proven
from serving import HANG, Home

from .conftest import Served, problem

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="users of POSIX")
NOBODY = 65534


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    found = Home(tmp_path_factory.mktemp("proof") / "state")
    found.serve()
    yield found
    found.end()


def clients(folder: Path) -> list[Callable[[], Any]]:
    """The two that look for a server: the command line's and the client for other programs; None where none is."""

    def client() -> Any:
        try:
            return hookean_client.connect(start=False, folder=str(folder))
        except hookean_client.Problem as problem:
            assert problem.slug in ("no-server", "distrusted"), problem
            return None

    return [lambda: find(folder), client]


class Stranger:
    """A program that listens where a server did. `answer` makes bytes of the request's head; all it is sent is kept.
    `closes`: every connection after one answer."""

    def __init__(
        self, answer: Callable[[bytes], bytes], *, closes: bool = False, address: tuple[str, int] = ("127.0.0.1", 0)
    ) -> None:
        self.heard, self.answer, self.closes = b"", answer, closes
        self.socket = socket.create_server(address)
        self.port: int = self.socket.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            try:
                connection, _ = self.socket.accept()
            except OSError:
                return
            threading.Thread(target=self._one, args=(connection,), daemon=True).start()

    def _one(self, connection: socket.socket) -> None:
        with connection:
            try:
                while data := connection.recv(65536):
                    self.heard += data
                    connection.sendall(self.answer(data))
                    if self.closes:
                        return
            except OSError:
                pass

    def told(self, folder: Path, like: Found) -> Found:
        """The file that leads here, as if the server of it had died and this had its port."""
        folder.mkdir(mode=0o700, exist_ok=True)
        found = replace(like, pid=os.getpid(), port=self.port, url=f"http://127.0.0.1:{self.port}")
        found.write(folder)
        return found


def as_json(body: object, more: str = "") -> bytes:
    text = json.dumps(body).encode()
    head = f"HTTP/1.1 200 OK\r\ncontent-type: application/json\r\n{more}content-length: {len(text)}\r\n\r\n"
    return head.encode() + text


def nonce_of(head: bytes) -> str:
    return head.split(b"nonce=")[1].split()[0].decode() if b"nonce=" in head else ""


def test_the_proof_is_the_hmac_of_a_nonce(home: Home) -> None:
    """RFC 2104 with SHA-256, by an implementation of its own: hash((key ^ opad) + hash((key ^ ipad) + text))."""
    told = home.told
    nonce = "0123456789abcdef" * 4
    said = httpx.get(f"{told['url']}/v1/proof", params={"nonce": nonce}, timeout=HANG).json()
    key = told["proof"].encode().ljust(64, b"\0")
    text = f"hookean {told['instance']} 127.0.0.1 {told['port']} {nonce}".encode()
    inner = hashlib.sha256(bytes(b ^ 0x36 for b in key) + text).digest()
    assert said == {
        "instance": told["instance"],
        "proof": hashlib.sha256(bytes(b ^ 0x5C for b in key) + inner).hexdigest(),
    }
    other = httpx.get(f"{told['url']}/v1/proof", params={"nonce": "1" + nonce[1:]}, timeout=HANG).json()
    assert other["proof"] != said["proof"]


@pytest.mark.parametrize("nonce", ["", "0" * 31, "0" * 129, "G" * 64, "0" * 64 + "\n", "A" * 64])
def test_what_is_no_nonce(served: Served, nonce: str) -> None:
    problem(served.client.get("/v1/proof", params={"nonce": nonce}), 422, "invalid-input")


def test_the_key_is_neither_the_token_nor_made_of_it(served: Served) -> None:
    """A token that somebody chose is short: what is open to everybody gives nothing to try guesses at."""
    nonce = "0" * 64
    said = served.client.get("/v1/proof", params={"nonce": nonce}).json()
    text = f"hookean {said['instance']} 127.0.0.1 {served.port} {nonce}".encode()
    assert hmac.new(served.token.encode(), text, "sha256").hexdigest() != said["proof"]


def test_both_find_a_server_that_proves_itself(home: Home) -> None:
    assert all(look() is not None for look in clients(home.folder))


LIES: dict[str, Callable[[bytes, Found], bytes]] = {
    "nothing": lambda head, like: as_json({"instance": like.instance}),
    "the instance, as before": lambda head, like: as_json({"service": "hookean", "instance": like.instance}),
    "zeros": lambda head, like: as_json({"instance": like.instance, "proof": "0" * 64}),
    "the nonce": lambda head, like: as_json({"instance": like.instance, "proof": nonce_of(head)}),
    "no text": lambda head, like: as_json({"instance": like.instance, "proof": None}),
    "a list": lambda head, like: as_json([1]),
    "no JSON": lambda head, like: b"HTTP/1.1 200 OK\r\ncontent-length: 2\r\n\r\n{]",
    "not ASCII": lambda head, like: as_json({"instance": like.instance, "proof": "é" * 64}),
    "a redirect": lambda head, like: (
        b"HTTP/1.1 302 Found\r\nlocation: http://127.0.0.1:1/\r\ncontent-length: 0\r\n\r\n"
    ),
}


@pytest.mark.thinned
@pytest.mark.parametrize("lie", LIES)
def test_a_stranger_who_has_the_port_is_sent_no_token(home: Home, tmp_path: Path, lie: str) -> None:
    """Whatever it says: neither the commands nor the client send it the token, nor the key."""
    like = find(home.folder)
    assert like is not None
    stranger = Stranger(lambda head: LIES[lie](head, like))
    found = stranger.told(tmp_path / "state", like)
    try:
        assert all(look() is None for look in clients(tmp_path / "state"))
        there = Home(tmp_path / "state")
        assert there.command("token").returncode == 1
        assert ask(found, "POST", "/v1/shutdown") is None
        assert b"GET /v1/proof?nonce=" in stranger.heard
        for secret in (like.token, like.proof, "authorization"):
            assert secret.encode() not in stranger.heard.lower() and secret.encode() not in stranger.heard
    finally:
        stranger.socket.close()


def test_an_old_proof_is_worth_nothing(home: Home, tmp_path: Path) -> None:
    """A stranger who has asked the server for proofs before it died replays them: every question has its own nonce."""
    like = find(home.folder)
    assert like is not None
    old = httpx.get(f"{like.url}/v1/proof", params={"nonce": "a" * 64}, timeout=HANG).json()
    stranger = Stranger(lambda head: as_json(old))
    stranger.told(tmp_path / "state", like)
    try:
        for _ in range(3):
            assert all(look() is None for look in clients(tmp_path / "state"))
        asked = {nonce_of(part) for part in stranger.heard.split(b"GET ")[1:]}
        assert len(asked) == 6 and all(len(nonce) == 64 for nonce in asked)
    finally:
        stranger.socket.close()


def test_a_proof_that_was_fetched_from_the_server_is_worth_nothing(home: Home, tmp_path: Path) -> None:
    """A stranger at another port passes the question on to the server that runs: the proof is of the server's port."""
    like = find(home.folder)
    assert like is not None
    stranger = Stranger(
        lambda head: as_json(httpx.get(f"{like.url}/v1/proof", params={"nonce": nonce_of(head)}, timeout=HANG).json())
    )
    stranger.told(tmp_path / "state", like)
    try:
        assert all(look() is None for look in clients(tmp_path / "state"))
        assert like.token.encode() not in stranger.heard
    finally:
        stranger.socket.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "0.0.0.0", "::"])
def test_servers_are_found_at_every_address(tmp_path: Path, host: str) -> None:
    """The file has an address, never a name or none in particular; what proves itself there is the server."""
    if ":" in host and not _has_ipv6():
        pytest.skip("this machine has no IPv6")
    there = Home(tmp_path / "state")
    try:
        process = there.start("--host", host, "--port", "0")
        assert process.stdout is not None and process.stdout.readline().startswith("hookean serves at")
        wanted = {"localhost": "127.0.0.1", "0.0.0.0": "127.0.0.1", "::": "[::1]", "::1": "[::1]"}.get(host, host)
        assert there.told["url"] == f"http://{wanted}:{there.told['port']}"
        assert all(look() is not None for look in clients(there.folder))
    finally:
        there.end()


def _has_ipv6() -> bool:
    try:
        socket.create_server(("::1", 0), family=socket.AF_INET6).close()
    except OSError:
        return False
    return True


def test_a_proof_that_was_fetched_at_another_address_is_worth_nothing(tmp_path: Path) -> None:
    """A server listens at all addresses; a stranger who got one of them at the same port, as some systems allow, passes
    the question on to the server at another one."""
    there = Home(tmp_path / "state")
    try:
        process = there.start("--host", "127.0.0.1", "--port", "0")
        assert process.stdout is not None and process.stdout.readline()
        like = find(there.folder)
        assert like is not None

        def passed_on(head: bytes) -> bytes:
            nonce = nonce_of(head)
            return as_json(httpx.get(f"{like.url}/v1/proof", params={"nonce": nonce}, timeout=HANG).json())

        stranger = Stranger(passed_on, address=("127.0.0.2", like.port))
        try:
            found = replace(like, url=f"http://127.0.0.2:{like.port}")
            found.write(there.folder)
            assert all(look() is None for look in clients(there.folder))
            assert b"nonce=" in stranger.heard and like.token.encode() not in stranger.heard
        finally:
            stranger.socket.close()
    finally:
        there.end()


def test_a_stranger_who_trickles_holds_nobody_up(home: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A byte now and then, for as long as the client listens: finding a server has a deadline for the whole."""
    like = find(home.folder)
    assert like is not None
    monkeypatch.setattr(discovery, "ANSWER", 1.0)
    monkeypatch.setattr(hookean_client.transport, "ANSWER", 1.0)
    left = threading.Semaphore(0)
    with socket.create_server(("127.0.0.1", 0)) as listening:

        def trickle() -> None:
            while True:
                try:
                    connection, _ = listening.accept()
                except OSError:
                    return
                with connection:
                    try:
                        connection.sendall(b"HTTP/1.1 200 OK\r\nx-long: ")
                        while True:
                            connection.sendall(b"x")
                            over.wait(0.05)
                    except OSError:
                        left.release()

        over = threading.Event()
        threading.Thread(target=trickle, daemon=True).start()
        port = listening.getsockname()[1]
        (tmp_path / "state").mkdir(mode=0o700)
        replace(like, port=port, url=f"http://127.0.0.1:{port}").write(tmp_path / "state")
        for look in clients(tmp_path / "state"):
            assert look() is None
            assert left.acquire(timeout=HANG), "who looked has left"
        over.set()


@pytest.mark.parametrize("announced", [True, False])
def test_the_token_goes_down_the_connection_that_was_proven(home: Home, tmp_path: Path, announced: bool) -> None:
    """A server that proves itself, closes, and leaves its port to a stranger: the next connection is another one, and
    must prove itself again. Here both are one program, which knows the key, and proves itself once."""
    like = find(home.folder)
    assert like is not None

    def once(head: bytes) -> bytes:
        nonce = nonce_of(head)
        if not nonce or stranger.heard.count(b"/v1/proof") > 1:
            return as_json({"instance": like.instance, "proof": "0" * 64})
        text = f"hookean {like.instance} 127.0.0.1 {stranger.port} {nonce}".encode()
        proof = hmac.new(like.proof.encode(), text, "sha256").hexdigest()
        return as_json({"instance": like.instance, "proof": proof}, "connection: close\r\n" if announced else "")

    def command(found: Found) -> None:
        connection = proven(found)
        assert (connection is None) == announced
        for _ in range(2 if connection is not None else 0):
            with pytest.raises((http.client.HTTPException, OSError)):
                assert connection is not None
                connection.request("GET", "/v1/sessions", headers={"authorization": f"Bearer {found.token}"})
                connection.getresponse()
        if connection is not None:
            connection.close()
        assert ask(found, "GET", "/v1/sessions") is None

    def client(found: Found) -> None:
        live = finding.reach(like.url, like.instance, like.proof, time.monotonic() + HANG)
        live.close()
        with pytest.raises(http.client.NotConnected):
            live.request("GET", "/v1/sessions")
        with pytest.raises(hookean_client.Problem):
            hookean_client.connect(start=False, folder=str(tmp_path / "client")).get("/v1/sessions", timeout=0.5)

    for look in (command, client):
        stranger = Stranger(once, closes=True)
        found = stranger.told(tmp_path / look.__name__, like)
        try:
            look(found)
            assert like.token.encode() not in stranger.heard
        finally:
            stranger.socket.close()


# files of others


def test_the_folder_and_its_files_are_checked(tmp_path: Path) -> None:
    place = tmp_path / "state"
    check(place)  # it is not there yet
    place.mkdir(mode=0o700)
    check(place)
    for mode in (0o770, 0o707, 0o777, 0o1777, 0o720):
        place.chmod(mode)
        with pytest.raises(Distrusted, match="chmod 700"):
            check(place)
    place.chmod(0o755)
    check(place)
    for name in ("server.json", "python.json"):
        (place / name).write_text("{}")
        for mode in (0o666, 0o620, 0o602):
            (place / name).chmod(mode)
            with pytest.raises(Distrusted, match=name):
                check(place)
        (place / name).chmod(0o600)
        check(place)


@pytest.mark.parametrize("command", [("serve",), ("serve", "--stop"), ("token",), ("studio", "--no-browser")])
def test_commands_refuse_a_folder_that_others_may_write_to(
    home: Home, tmp_path: Path, command: tuple[str, ...]
) -> None:
    """One sentence that says what to do, exit code 2, nothing written and nobody asked."""
    there = Home(tmp_path / "state")
    there.folder.mkdir()
    there.folder.chmod(0o777)
    (there.folder / "server.json").write_text(json.dumps(home.told))
    (there.folder / "server.json").chmod(0o600)
    before = sorted(there.folder.iterdir())
    done = there.command(*command)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1, done
    assert "chmod 700" in done.stderr and "HOOKEAN_STATE" in done.stderr
    assert sorted(there.folder.iterdir()) == before
    with pytest.raises(hookean_client.Problem, match="chmod 700"):
        hookean_client.connect(folder=str(there.folder), python=sys.executable)
    assert sorted(there.folder.iterdir()) == before


@pytest.mark.parametrize("kind", ["link", "dangling", "pipe", "folder", "writable"])
def test_what_is_no_file_of_ours_is_not_read(home: Home, tmp_path: Path, kind: str) -> None:
    """A link to a good file, a link to nothing, a pipe that nobody writes to, a folder, a file that others can write:
    none leads to a server, none is waited for, and no Python named there is started."""
    place = tmp_path / "state"
    place.mkdir(mode=0o700)
    for name in ("server.json", "python.json"):
        path = place / name
        if kind == "link":
            path.symlink_to(home.folder / name)
        elif kind == "dangling":
            path.symlink_to(tmp_path / "nothing")
        elif kind == "pipe":
            os.mkfifo(path)
        elif kind == "folder":
            path.mkdir()
        else:
            shutil.copy(home.folder / name, path)
            path.chmod(0o622)
    assert find(place) is None
    with pytest.raises(hookean_client.Problem) as found:
        hookean_client.connect(folder=str(place), timeout=0.1)
    assert found.value.slug == "distrusted" and "server.json" in str(found.value)
    assert not (tmp_path / "nothing").exists()


def test_files_of_another_user_are_refused(home: Home) -> None:
    """`nobody` makes a folder with a file that leads to our server, and one that leads to a Python of theirs; then the
    same files in a folder of ours. Neither is believed."""
    if os.getuid() != 0:
        pytest.skip("takes root, who can be another user")
    top = Path(tempfile.mkdtemp(prefix="hookean-foreign-"))
    try:
        top.chmod(0o777)
        ran = top / "ran"
        code = (
            "import json, os, sys\nos.setgroups([]); os.setgid(65534); os.setuid(65534); os.umask(0o077)\n"
            "os.mkdir(sys.argv[1])\n"
            "for name, text in json.loads(sys.argv[2]).items():\n"
            "    open(os.path.join(sys.argv[1], name), 'w').write(text)\n"
            "os.chmod(sys.argv[1], 0o755)\n"
        )
        evil = top / "python"
        evil.write_text(f"#!/bin/sh\ntouch {ran}\n")
        evil.chmod(0o755)
        files = {"server.json": json.dumps(home.told), "python.json": json.dumps({"python": str(evil)})}
        subprocess.run([sys.executable, "-c", code, str(top / "theirs"), json.dumps(files)], check=True, timeout=HANG)
        (top / "ours").mkdir(mode=0o700)
        for name in files:
            (top / "theirs" / name).chmod(0o644)
            shutil.copy2(top / "theirs" / name, top / "ours" / name)
            os.chown(top / "ours" / name, NOBODY, NOBODY)
        assert (top / "theirs").stat().st_uid == NOBODY
        for place in (top / "theirs", top / "ours"):
            assert find(place) is None
            with pytest.raises(Distrusted):
                check(place)
            with pytest.raises(hookean_client.Problem) as found:
                hookean_client.connect(folder=str(place), timeout=0.1)
            assert found.value.slug == "distrusted"
            there = Home(place)
            there.environment.pop("HOOKEAN_PYTHON")
            for command in (("token",), ("serve", "--stop"), ("serve", "--port", "0")):
                done = there.command(*command)
                assert done.returncode == 2 and str(place) in done.stderr, done
        assert not ran.exists()
    finally:
        shutil.rmtree(top)


def test_the_files_are_unreadable_to_another_user(home: Home) -> None:
    """`nobody`, who knows where they are, cannot open them, whatever their folder allows."""
    if os.getuid() != 0:
        pytest.skip("takes root, who can be another user")
    top = Path(tempfile.mkdtemp(prefix="hookean-open-"))
    there = Home(top / "state")
    try:
        top.chmod(0o755)
        there.serve()
        there.folder.chmod(0o755)
        code = "import os, sys\nos.setgroups([]); os.setgid(65534); os.setuid(65534)\nopen(sys.argv[1]).read()"
        for name in ("server.json", "python.json", "sessions.db", "server.lock"):
            done = subprocess.run(
                [sys.executable, "-c", code, str(there.folder / name)], capture_output=True, timeout=HANG, check=False
            )
            assert done.returncode == 1 and b"PermissionError" in done.stderr, name
    finally:
        there.end()
        shutil.rmtree(top)


def test_a_folder_reached_by_a_link_is_the_folder(tmp_path: Path) -> None:
    """HOOKEAN_STATE may name a link of the user's own; what counts is where it leads."""
    (tmp_path / "real").mkdir(mode=0o700)
    (tmp_path / "state").symlink_to(tmp_path / "real")
    check(tmp_path / "state")
    (tmp_path / "real").chmod(0o777)
    with pytest.raises(Distrusted):
        discovery.prepare(tmp_path / "state")
