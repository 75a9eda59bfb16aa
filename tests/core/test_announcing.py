"""Who waits for code to be compiled learns of it: once for a process, after a second, on a terminal and in the log."""

from __future__ import annotations

import io
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr

import pytest

from hookean.compiled.announcing import AFTER, LINE, Waiting, later
from serving import HANG


class Clock:
    """A time that goes on when told so, and does then what is due."""

    def __init__(self) -> None:
        self.now = 0.0
        self.due: list[tuple[float, Callable[[], None]]] = []

    def __call__(self) -> float:
        return self.now

    def later(self, seconds: float, act: Callable[[], None]) -> Callable[[], None]:
        entry = (self.now + seconds, act)
        self.due.append(entry)
        return lambda: self.due.remove(entry) if entry in self.due else None

    def go(self, seconds: float) -> None:
        self.now += seconds
        for entry in [one for one in self.due if one[0] <= self.now]:
            self.due.remove(entry)
            entry[1]()


class Terminal(io.StringIO):
    """Standard errors that a person reads."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock() -> Clock:
    return Clock()


@contextmanager
def terminal() -> Iterator[Terminal]:
    """In place of standard errors; no fixture, for pytest puts its own there before each test."""
    with redirect_stderr(Terminal()) as shown:
        yield shown


@pytest.fixture(autouse=True)
def logged(caplog: pytest.LogCaptureFixture) -> pytest.LogCaptureFixture:
    caplog.set_level(logging.INFO, "hookean.compiled")
    return caplog


def test_nothing_is_said_of_what_takes_less_than_a_second(clock: Clock, logged: pytest.LogCaptureFixture) -> None:
    """And nothing is left that would say it later."""
    with terminal() as shown:
        with Waiting(clock, clock.later).on("springs_kernel"):
            clock.go(0.9 * AFTER)
        clock.go(10.0 * AFTER)
    assert shown.getvalue() == "" and logged.messages == [] and clock.due == []


def test_one_line_while_a_function_is_still_being_compiled(clock: Clock, logged: pytest.LogCaptureFixture) -> None:
    """At the end of the first second, not after the function; and never again."""
    waiting = Waiting(clock, clock.later)
    with terminal() as shown:
        with waiting.on("springs_kernel"):
            clock.go(AFTER)
            assert shown.getvalue() == f"{LINE}\n"
        with waiting.on("beam_kernel"):
            clock.go(20.0 * AFTER)
    assert shown.getvalue() == f"{LINE}\n"
    [message] = logged.messages
    assert message.startswith("code is being compiled, now that of springs_kernel;")


def test_the_second_counts_over_all_functions_of_a_process(clock: Clock, logged: pytest.LogCaptureFixture) -> None:
    """A scene needs many that take half a second each: the time between them, when nothing is compiled, counts not."""
    waiting = Waiting(clock, clock.later)
    with terminal() as shown:
        for name in ("one", "two"):
            with waiting.on(name):
                clock.go(0.4 * AFTER)
            clock.go(5.0 * AFTER)
        assert shown.getvalue() == ""
        with waiting.on("three"):
            clock.go(0.3 * AFTER)
    assert shown.getvalue() == f"{LINE}\n" and "that of three;" in logged.text


def test_what_fails_to_compile_says_no_more(clock: Clock) -> None:
    """The error passes, the line is called off."""
    with terminal() as shown:
        with pytest.raises(ZeroDivisionError), Waiting(clock, clock.later).on("springs_kernel"):
            raise ZeroDivisionError
        clock.go(10.0 * AFTER)
    assert shown.getvalue() == "" and clock.due == []


@pytest.mark.parametrize("stderr", [io.StringIO(), None], ids=["a pipe", "a window"])
def test_a_pipe_gets_no_line_but_the_log_its_entry(
    stderr: io.StringIO | None, clock: Clock, logged: pytest.LogCaptureFixture
) -> None:
    """Programs that read standard errors find them as they are when everything is compiled."""
    with redirect_stderr(stderr), Waiting(clock, clock.later).on("springs_kernel"):
        clock.go(AFTER)
    assert len(logged.messages) == 1 and (stderr is None or stderr.getvalue() == "")


def test_what_is_to_be_said_later_comes_from_a_thread_of_its_own() -> None:
    """The clock of a process: it is said, unless it is called off."""
    from threading import Event

    said = Event()
    later(0.0, said.set)
    assert said.wait(HANG)
    never = Event()
    later(HANG, never.set)()
    assert not never.is_set()
