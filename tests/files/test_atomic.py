"""Files that are replaced in one step: links are written through, and what a killed process left is deleted."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import forking
from hookean import atomic_write
from hookean.atomic_write import put
from hookean.errors import InputError

pytestmark = pytest.mark.skipif(os.name != "posix", reason="links and processes of POSIX")
SCENE = '{"particles": [[0,0,0],[1,0,0],[2,0,0]], "anchors": [{"particles": [0,2]}], "forces": ['
SCENE += '{"kind": "springs", "particles": [[0,1],[1,2]]}, {"kind": "unary", "particles": [1], "vector": [0,0,-9]}]}'


def no_check(data: bytes) -> None:
    pass


@pytest.mark.parametrize("there", [True, False], ids=["to a file", "to no file yet"])
def test_a_link_is_written_through(there: bool, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    real, link = tmp_path / "real" / "a.3dm", tmp_path / "a.3dm"
    if there:
        real.write_bytes(b"before")
    link.symlink_to(Path("real") / "a.3dm")
    put(link, b"after", no_check)
    assert link.is_symlink() and real.read_bytes() == b"after" and not real.is_symlink()
    assert [f.name for f in real.parent.iterdir()] == ["a.3dm"]


def test_a_link_to_nowhere_is_refused_by_its_name(tmp_path: Path) -> None:
    link = tmp_path / "a.3dm"
    link.symlink_to(tmp_path / "none" / "a.3dm")
    with pytest.raises(InputError, match=r"a\.3dm"):
        put(link, b"after", no_check)
    assert link.is_symlink()


def test_outputs_of_the_command_line_keep_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """-o, --report and --csv of `hookean relax`."""
    (tmp_path / "scene.json").write_text(SCENE)
    (tmp_path / "real").mkdir()
    names = ("out.json", "report.json", "table.csv")
    for name in names:
        (tmp_path / "real" / name).write_text("before")
        (tmp_path / name).symlink_to(tmp_path / "real" / name)
    monkeypatch.chdir(tmp_path)
    words = ["relax", "scene.json", "-o", names[0], "--report", names[1], "--csv", names[2]]
    done = forking.run(forking.COMMAND, *words)
    assert done.returncode == 0, done.stderr
    for name in names:
        assert (tmp_path / name).is_symlink() and (tmp_path / "real" / name).read_text() != "before"


@pytest.mark.slow
def test_what_a_killed_process_left_is_deleted_with_the_next_write(tmp_path: Path) -> None:
    """And nothing else: neither files of processes that live, nor of other machines."""
    code = "import os, sys; from hookean import atomic_write as a; from pathlib import Path;"
    code += "a.put(Path(sys.argv[1]), b'x' * 10, lambda back: os.kill(os.getpid(), 9))"
    target = tmp_path / "a.3dm"
    subprocess.run([sys.executable, "-c", code, str(target)], timeout=300)
    (left,) = tmp_path.iterdir()
    assert left.name.endswith(".hookean")
    mine = tmp_path / f".{atomic_write._process(os.getpid())}-0123456789abcdef.hookean"
    other = tmp_path / f".{2**22 + 1}-00000000-0123456789abcdef.hookean"
    mine.touch(), other.touch()
    put(target, b"after", no_check)
    assert set(tmp_path.iterdir()) == {target, mine, other}


def test_a_pipe_is_not_replaced_by_a_file(tmp_path: Path) -> None:
    """Nor is a device: as root, a table written to /dev/full once was that file for all programs."""
    pipe, link = tmp_path / "out.csv", tmp_path / "link.csv"
    os.mkfifo(pipe)
    link.symlink_to(pipe)
    for path in (pipe, link):
        with pytest.raises(InputError, match="is a device or a pipe, not a file"):
            put(path, b"after", no_check)
    assert pipe.is_fifo() and sorted(f.name for f in tmp_path.iterdir()) == ["link.csv", "out.csv"]
