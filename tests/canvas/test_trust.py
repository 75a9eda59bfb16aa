"""Scripts of a definition run as the person who runs it: a file that is not trusted does not run."""

from __future__ import annotations

import hashlib
import os
import shutil
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from hookean.commands.examples import home
from hookean_canvas import archive
from hookean_canvas.command import app
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import graph, trust
from serving import HANG
from soak import sampled

SHIPPED = sorted(home().glob("*/definition.gh"))


class Person:
    """Somebody with a data folder of their own and a definition whose script leaves a trace."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.trace = folder, folder / "trace"
        self.environment = {**os.environ, "XDG_DATA_HOME": str(folder / "data"), "HOME": str(folder)}
        self.environment.pop("HOOKEAN_TRUST", None)
        self.remembered = folder / "data" / "hookean" / "trusted-definitions.txt"

    def definition(self, name: str = "a.ghx", more: str = "") -> Path:
        d = Definition("trace", "Trace", "Leaves a trace." + more)
        code = f"with open({str(self.trace)!r}, 'a') as trace:\n    trace.write('x')\na = 2 * x"
        d.numbers(code, {"x": d.slider("X", 6, 0, 10)}, {"a": "twice"})
        d.save(self.folder / name)
        return self.folder / name

    def command(self, *words: str) -> subprocess.CompletedProcess[str]:
        """`hookean canvas` with these words, in a process of its own."""
        command = [sys.executable, "-m", "hookean.cli", "canvas", *words]
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=HANG, check=False)

    def run(self, file: Path, *words: str, **variables: str) -> Result:
        """`hookean canvas run` of a file, in this process."""
        environment = {name: self.environment.get(name) for name in ("HOME", "XDG_DATA_HOME", "HOOKEAN_TRUST")}
        found = CliRunner().invoke(app, ["run", str(file), *words], env={**environment, **variables})
        assert found.exception is None or isinstance(found.exception, SystemExit), found.exception
        return found

    @property
    def times(self) -> int:
        """How often the script has run."""
        return len(self.trace.read_text()) if self.trace.exists() else 0


@pytest.fixture
def person(tmp_path: Path) -> Person:
    return Person(tmp_path)


pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="XDG_DATA_HOME moves the folder on Linux alone")


def test_a_file_that_was_not_run_before_is_refused(person: Person) -> None:
    """Nothing of it runs; one sentence says why and what to do; with --trust it runs, says that it does, and is
    remembered by its bytes, under every name; after a change it is asked again."""
    file = person.definition()
    refused = person.command("run", str(file))
    assert refused.returncode == 2 and refused.stdout == "" and person.times == 0 and not person.remembered.exists()
    assert refused.stderr.count("\n") == 1
    assert "runs with your rights" in refused.stderr and "--trust" in refused.stderr and "show --code" in refused.stderr
    trusted = person.command("run", str(file), "--trust")
    assert (trusted.returncode, trusted.stdout) == (0, "twice: 12\n") and person.times == 1
    assert "runs with your rights" in trusted.stderr
    again = person.run(file)
    assert (again.exit_code, again.stdout) == (0, "twice: 12\n") and "runs with your rights" in again.stderr
    shutil.copy(file, person.folder / "b.ghx")
    assert person.run(person.folder / "b.ghx").exit_code == 0 and person.times == 3
    changed = person.definition(more=" Changed.")
    assert person.run(changed).exit_code == 2 and person.times == 3
    assert person.remembered.stat().st_mode & 0o777 == 0o600
    assert len(person.remembered.read_text().split()) == 1


def test_the_variable_is_for_ci(person: Person) -> None:
    """1 trusts every file and remembers none; anything else trusts no file."""
    file = person.definition()
    for value in ("", "0", "yes", "11"):
        assert person.run(file, HOOKEAN_TRUST=value).exit_code == 2
    assert person.run(file, HOOKEAN_TRUST="1").exit_code == 0
    assert person.run(file).exit_code == 2 and person.times == 1


def test_a_definition_without_scripts_needs_no_trust(person: Person) -> None:
    d = Definition("plain", "Plain", "No script.")
    d.panel("length", d.native("List Length", list=d.parameter("Number", "Numbers", [1.0, 2.0])))
    d.save(person.folder / "plain.ghx")
    done = person.run(person.folder / "plain.ghx")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "length: 2\n", "")


@pytest.mark.parametrize("path", sampled(SHIPPED, 8), ids=lambda path: path.parent.name)
def test_what_is_shipped_is_trusted_by_its_digest(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also as a copy elsewhere; not with one byte more."""
    monkeypatch.delenv("HOOKEAN_TRUST")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    data = path.read_bytes()
    found = graph.parse(data, path)
    trust.require(found, data, tmp_path / "copy.ghx", False)
    assert (trust.scripts(found) > 0) == ("with your rights" in capsys.readouterr().err)
    if trust.scripts(found):
        with pytest.raises(trust.InputError, match="--trust"):
            trust.require(found, data + b" ", path, False)


def test_what_is_judged_is_what_runs(person: Person, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is replaced at the moment it was judged runs as it was judged: it is read once."""
    from hookean_canvas.run import checking

    evil, good = person.definition("evil.ghx", " Evil."), person.folder / "good.ghx"
    d = Definition("good", "Good", "Nothing evil.")
    d.numbers("a = 2 * x", {"x": d.slider("X", 6, 0, 10)}, {"a": "twice"})
    d.save(good)
    monkeypatch.delenv("HOOKEAN_TRUST")
    monkeypatch.setenv("XDG_DATA_HOME", str(person.folder / "data"))
    data = good.read_bytes()
    trust.require(graph.parse(data, good), data, good, True)
    require = trust.require

    def swapped(*given: object) -> None:
        require(*given)  # type: ignore[arg-type]
        shutil.copy(evil, good)

    monkeypatch.setattr(checking, "require", swapped)
    checked = checking.check(good, trust=False)
    assert checked.outcome.panels["twice"].values_in_order() == [12] and person.times == 0


@pytest.mark.parametrize("kind", ["writable", "link", "pipe", "folder", "rubbish"])
def test_a_list_that_others_could_have_written_is_not_believed(person: Person, kind: str) -> None:
    file = person.definition()
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    person.remembered.parent.mkdir(parents=True)
    if kind == "writable":
        person.remembered.write_text(digest)
        person.remembered.chmod(0o666)
    elif kind == "link":
        (person.folder / "other").write_text(digest)
        person.remembered.symlink_to(person.folder / "other")
    elif kind == "pipe":
        os.mkfifo(person.remembered)
    elif kind == "folder":
        person.remembered.mkdir()
    else:
        person.remembered.write_bytes(b"\xff" + digest.encode())
    done = person.run(file)
    assert done.exit_code == 2 and person.times == 0 and "Traceback" not in done.stderr
    if kind != "rubbish":
        done = person.run(file, "--trust")
        assert done.exit_code == 0 and "Traceback" not in done.stderr
        assert "cannot be used" in done.stderr and person.run(file).exit_code == 2
    if kind == "link":
        assert (person.folder / "other").read_text() == digest, "nothing is written through a link"


def test_a_list_of_another_user_is_not_believed(person: Person) -> None:
    if os.getuid() != 0:
        pytest.skip("takes root, who can be another user")
    file = person.definition()
    person.remembered.parent.mkdir(parents=True)
    person.remembered.write_text(hashlib.sha256(file.read_bytes()).hexdigest())
    os.chown(person.remembered, 65534, 65534)
    assert person.run(file).exit_code == 2 and person.times == 0


def test_files_that_are_trusted_at_once_are_all_remembered(person: Person, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(person.folder / "data"))
    contents = [f"definition {number}".encode() for number in range(40)]
    threads = [threading.Thread(target=trust._remember, args=(data,)) for data in contents]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert trust._remembered() == {hashlib.sha256(data).hexdigest() for data in contents}
    assert stat.S_IMODE(person.remembered.stat().st_mode) == 0o600


@pytest.mark.soak
def test_commands_that_run_nothing_need_no_trust(person: Person) -> None:
    file = person.definition()
    for words in (["show", str(file)], ["check", str(file)], ["draw", str(file), "-o", str(person.folder / "x.png")]):
        done = person.command(*words)
        assert done.returncode == 0, done
    assert person.times == 0 and archive.read(file) is not None
