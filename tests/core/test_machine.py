"""Code from the disk is numba's own, to the bit, and a process that has it does without numba."""

from __future__ import annotations

import errno
import gc
import os
import shutil
import subprocess
import sys
import threading
import weakref
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean.compiled import announcing, dispatch
from hookean.compiled import object_cache as machine
from hookean.compiled.object_cache import Compiled, readable
from hookean.forces.springs import Springs, springs_kernel
from serving import HANG

pytestmark = pytest.mark.skipif(sys.platform == "win32" or not readable(), reason="numba compiles here")


def scaled(x, factor, count, twice):  # type: ignore[no-untyped-def]
    """Arrays, memory, a number, a whole number and a truth in; three of them out."""
    other = x * factor
    for i in range(count):
        for j in range(x.shape[1]):
            x[i, j] = other[i, j] * (2.0 if twice else 1.0)
    return x.sum(), count + x.shape[1], not twice


@dispatch.device
def next_one(number):  # type: ignore[no-untyped-def]
    """One more."""
    return number + 1


def after_seven(number):  # type: ignore[no-untyped-def]
    """`next_one` of a constant and of an argument."""
    return next_one(7) + next_one(number)


def code(folder: Path) -> Compiled:
    """`scaled` from an empty folder, as a new process sees it."""
    return Compiled(
        "scaled", folder, lambda: dispatch.dispatcher(scaled), None, lambda: dispatch.part(scaled, None, True)
    )


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the code of `scaled` for numbers in double precision."""
    folder = tmp_path_factory.mktemp("code")
    code(folder)(np.ones((2, 2)), 1.0, 2, False)
    return folder


@pytest.fixture(autouse=True)
def nothing_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a new process, of which nobody waits."""
    monkeypatch.setattr(machine, "_reported", set())
    monkeypatch.setattr(announcing, "WAITING", announcing.Waiting(later=lambda seconds, act: lambda: None))


@pytest.fixture
def folder(stored: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(stored, tmp_path / "code"))


def test_a_constant_compiles_no_code_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whole numbers have one code, written as a constant or given; nothing is on the disk before."""
    monkeypatch.setattr(dispatch, "cache_folder", lambda function: tmp_path)
    assert dispatch.dispatcher(after_seven)(4) == 13
    assert len(dispatch.dispatcher(next_one).overloads) == 1


def test_what_numba_runs_and_what_the_disk_keeps_are_stored_apart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A function that numba has compiled for itself, with its devices, is compiled for the disk by the next process."""
    monkeypatch.setattr(dispatch, "cache_folder", lambda function: tmp_path)
    dispatch.dispatcher.__wrapped__(after_seven)(4)
    run = Compiled(
        "after_seven", tmp_path, lambda: pytest.fail("numba was asked"), None, lambda: _new_part(after_seven)
    )
    assert run(4) == 13 and run.made == 1
    again = Compiled("other", tmp_path, lambda: pytest.fail("numba was asked"), None, lambda: _new_part(after_seven))
    assert again(4) == 13 and again.made == 1
    assert caplog.messages == []


def _new_part(function: Any) -> Any:
    """As a new process makes it, which finds the devices on the disk."""
    dispatch.part.cache_clear()
    return dispatch.part(function, None, True)


@pytest.mark.slow
def test_code_from_the_disk_gives_the_same_bits_as_numba() -> None:
    """One kernel on the same numbers: numba's machine code and that of its file."""
    springs, x = Springs.example()
    block, memory = springs.compile(_Places(x)), np.zeros((4, 1))
    answers = []
    for run in (dispatch.dispatcher(springs_kernel, "force"), dispatch.compiled(springs_kernel, "force")):
        f, w = np.zeros_like(x), np.zeros(len(x))
        energy = run(x, 0.1 * x, block.indices, block.parameters, memory, f, w)
        answers.append((energy, f.tobytes(), w.tobytes()))
    assert answers[0] == answers[1]


class _Places:
    def __init__(self, x: np.ndarray) -> None:
        self.x = x

    def elements(self, force: Springs) -> np.ndarray:
        return np.array(force.particles)


@pytest.mark.slow
def test_values_go_in_and_out_as_they_do_with_numba(tmp_path: Path) -> None:
    """First made, then found: the same answers, shapes empty ones too."""
    for made, loaded in ((1, 0), (0, 1)):
        run = code(tmp_path)
        x = np.arange(6.0).reshape(3, 2)
        assert run(x, 0.5, 2, True) == (1.0 + 0.0 + 2.0 + 3.0 + 9.0, 4, False)
        assert (x == [[0, 1], [2, 3], [4, 5]]).all()
        assert run(np.zeros((0, 4)), 1.0, 0, False) == (0.0, 4, True)
        assert (run.made, run.loaded) == (made, loaded)


@pytest.mark.slow
def test_values_of_two_kinds_in_turn_go_to_the_code_of_each(folder: Path) -> None:
    """Numbers in single and in double precision: each keeps its own, and its code is made or found once."""
    run = code(folder)
    for _ in range(3):
        for letter in "fd":
            x = np.full((1, 2), 0.1, letter)
            assert run(x, 1.0, 1, False) == (float(x.astype("d").sum()), 3, True)
            assert x.dtype.char == letter and (x == np.full((1, 2), 0.1, letter)).all()
    assert (run.made, run.loaded) == (1, 1)


@pytest.mark.slow
def test_a_thread_that_finds_the_code_just_loaded_calls_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """While it looked what its values are another thread has called the same code: numba is not asked."""
    run, look = code(folder), machine.kind_of

    def late(values: tuple[object, ...]) -> machine.Kind | None:
        kind = look(values)
        assert kind is not None
        entry = run.entry(kind, values)
        assert entry is not None
        run._called, run.dispatcher = (entry,), lambda: pytest.fail("numba was asked")
        return kind

    monkeypatch.setattr(machine, "kind_of", late)
    assert run(np.ones((1, 2)), 1.0, 1, False) == (2.0, 3, True)


def test_code_stays_where_it_is_when_who_loaded_it_is_gone(folder: Path) -> None:
    """Tables keep addresses of it."""
    run = code(folder)
    run(np.ones((1, 2)), 1.0, 1, False)
    (entry,) = run._entries.values()
    assert entry is not None
    engine = weakref.ref(entry.engine)
    del run, entry
    gc.collect()
    assert engine() is not None


@pytest.mark.slow
def test_what_the_disk_has_no_code_for_is_left_to_numba(tmp_path: Path) -> None:
    """Columns apart, which no entry reads, are summed right."""
    apart = np.arange(12.0).reshape(3, 4)[:, ::2]
    assert code(tmp_path)(apart, 1.0, 3, False) == (0.0 + 2 + 4 + 6 + 8 + 10, 5, True)
    assert not list(tmp_path.iterdir())


def test_code_that_another_process_compiles_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Locks belong to open files, so that threads stand for processes: one compiles, the other loads what it stored."""
    pytest.importorskip("fcntl", reason="there are no file locks here")
    make, begun, go = Compiled._make, threading.Event(), threading.Event()

    def slow(*given: Any) -> Any:
        begun.set()
        assert go.wait(HANG)
        return make(*given)

    monkeypatch.setattr(Compiled, "_make", slow)
    first, second = code(tmp_path), code(tmp_path)
    with ThreadPoolExecutor() as pool:
        answers = [pool.submit(run, np.ones((2, 2)), 1.0, 2, False) for run in (first, second)]
        assert begun.wait(HANG)
        go.set()
        assert [answer.result(HANG) for answer in answers] == [(4.0, 4, True)] * 2
    assert sorted([(first.made, first.loaded), (second.made, second.loaded)]) == [(0, 1), (1, 0)]
    assert [file.suffix for file in tmp_path.iterdir()] == [".o"]


def test_code_is_not_waited_for_without_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that holds the lock and does not go on holds up nobody else."""
    fcntl = pytest.importorskip("fcntl", reason="there are no file locks here")
    first = code(tmp_path)
    first(np.ones((2, 2)), 1.0, 2, False)
    (file,) = tmp_path.iterdir()
    file.unlink()
    monkeypatch.setattr(machine, "PATIENCE", 0.1)
    with file.with_suffix(".lock").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        second = code(tmp_path)
        assert second(np.ones((2, 2)), 1.0, 2, False) == (4.0, 4, True)
    assert second.made == 1 and file.is_file()


def test_a_file_system_without_locks_holds_nothing_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`flock` fails on some network drives; the code is compiled and stored without it."""
    fcntl = pytest.importorskip("fcntl", reason="there are no file locks here")

    def fails(*given: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", fails)
    monkeypatch.setattr(machine.time, "sleep", lambda seconds: pytest.fail("it waited"))
    run = code(tmp_path)
    assert run(np.ones((2, 2)), 1.0, 2, False) == (4.0, 4, True)
    assert run.made == 1 and [file.suffix for file in tmp_path.iterdir()] == [".o"]


DAMAGES = {
    "one byte changed": lambda whole: whole[:-1] + bytes([whole[-1] ^ 1]),
    "cut off": lambda whole: whole[: len(whole) // 2],
    "empty": lambda whole: b"",
    "another": lambda whole: b"nothing",
}


@pytest.mark.parametrize(
    "damage", [name if name == "one byte changed" else pytest.param(name, marks=pytest.mark.soak) for name in DAMAGES]
)
def test_a_damaged_file_is_replaced(damage: str, folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Compiled again, and put right; each finds its bytes wrong before it looks at what they are."""
    x = np.ones((2, 2))
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(DAMAGES[damage](whole))
    run = code(folder)
    assert run(x, 1.0, 2, False) == (4.0, 4, True)
    assert (run.made, run.loaded) == (1, 0) and file.read_bytes() == whole
    [line] = caplog.messages
    assert line.startswith(f"{file.name} was not loaded and is compiled again: ")


def test_code_that_cannot_be_stored_is_run_by_numba_and_the_reason_logged_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """As when a private part of numba or llvmlite has changed."""

    def changed(*given: object) -> bytes:
        raise AttributeError("'Module' object has no attribute 'as_bitcode'")

    monkeypatch.setattr("hookean.compiled.object_code.emit", changed)
    for _ in range(2):
        assert code(tmp_path)(np.ones((2, 2)), 1.0, 2, False) == (4.0, 4, True)
    [line] = caplog.messages
    assert line == "scaled was compiled but not stored: AttributeError: 'Module' object has no attribute 'as_bitcode'"
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize("empty", [False, pytest.param(True, marks=pytest.mark.soak)])
def test_a_small_cable_relaxes_without_numba_in_the_second_process(empty: bool, tmp_path: Path) -> None:
    """All of it: reading, compiling, solving and judging a cable imports neither numba nor scipy. From the cache of
    all tests, which the first fills where it has to, and from an empty one."""
    first, second = (cable(**({"HOOKEAN_CACHE": str(tmp_path)} if empty else {})) for _ in range(2))
    assert first[0] == second[0]
    assert second[1] == "[]\n"


LOADED = (
    "import sys, numpy as np\n"
    "from hookean.compiled import dispatch\n"
    "from hookean.forces.unary import unary_kernel\n"
    "x, indices, parameters = np.linspace(0, 1, 6).reshape(2, 3), np.array([[1], [0]]), np.full((2, 9), 0.1)\n"
    "f, w = np.zeros((2, 3)), np.zeros(2)\n"
    "energy = dispatch.compiled(unary_kernel, 'force')(x, x, indices, parameters, np.zeros((2, 1)), f, w)\n"
    "print(energy.hex() + f.tobytes().hex(), [m for m in ('numba',) if m in sys.modules])"
)
"""A process that calls the smallest kernel."""


@pytest.mark.slow
def test_a_kernel_with_the_object_cache_switched_off_gives_the_same_bits() -> None:
    """HOOKEAN_OBJECT_CACHE=0: numba is imported, and runs the kernel."""
    kept, plain = printed(LOADED), printed(LOADED, HOOKEAN_OBJECT_CACHE="0")
    assert plain[0] == kept[0] and len(kept[0]) > 96
    assert "'numba'" in plain[1]


@pytest.mark.soak
def test_with_the_object_cache_switched_off_numba_gives_the_same_bits() -> None:
    """The same of a cable: numba compiles all of it once more."""
    kept, plain = cable(), cable(HOOKEAN_OBJECT_CACHE="0")
    assert plain[0] == kept[0]
    assert "'numba'" in plain[1]


def cable(**environment: str) -> list[str]:
    """A small cable at rest in a fresh process: its particles, and which of numba and scipy were imported."""
    code = (
        "import sys, hookean\n"
        "lines = [[[i, 0, 0], [i + 1, 0, 0]] for i in range(10)]\n"
        "scene = hookean.Scene(forces=[{'kind': 'springs', 'lines': lines}, {'kind': 'self_weight', 'total': 9}],\n"
        "                      anchors=[{'points': [[0, 0, 0], [10, 0, 0]]}])\n"
        "result = hookean.relax(scene)\n"
        "assert result.converged, result.message\n"
        "print(result.particles.tobytes().hex(), [m for m in ('numba', 'scipy') if m in sys.modules])"
    )
    return printed(code, **environment)


def printed(code: str, **environment: str) -> list[str]:
    """The two words that a fresh process prints."""
    command = [sys.executable, "-W", "error", "-c", code]
    whole = {**os.environ, **environment}
    done = subprocess.run(command, env=whole, check=True, capture_output=True, text=True, timeout=HANG)
    assert not done.stderr
    return done.stdout.split(" ", 1)
