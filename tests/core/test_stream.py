"""Streams: rows that drive loads, read as they come, held until the next; wrong rows told by their line."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest

from hookean import InputError, Scene, Simulation, Stream, simulate
from samples import cable

DRIVE = {"force": "wind", "column": "vector", "source": "speed [m/s]", "scale": [0, 0.5, 0], "power": 2}
SCRIPT = {"drives": [DRIVE]}
HEAD = "time [s],speed [m/s]\n"


def windy(**settings: object) -> Scene:
    """The cable with a side load that the wind drives."""
    scene = cable(**settings).model_dump()
    scene["forces"] += ({"kind": "unary", "name": "wind", "particles": [1, 2, 3, 4], "vector": [0, 0, 0]},)
    return Scene(**scene)


def load(simulation: Simulation) -> float:
    """The y of the wind's force."""
    return float(simulation.result().force("wind")["force"][0, 1])


def test_a_row_stands_until_the_next_and_means_its_power():
    """scale * speed^2, held in between: 0.5 * 16 = 8 up to t = 1, then 0.5 * 36 = 18; rows due at a frame's end act
    from the next step."""
    simulation = Simulation(windy(), SCRIPT, [HEAD, "0,4\n", "1,6\n", "9,0\n"])
    seen = []
    for _ in range(8):
        simulation.step()
        seen.append((round(simulation.state.time, 9), load(simulation)))
    assert [f for _, f in seen] == pytest.approx([8.0] * 5 + [18.0] * 3)


def test_the_first_row_is_the_start_whatever_its_clock_says():
    """Rows at 1000 s and 1001 s are those at 0 and 1, in minutes too."""
    for head, first, second in ((HEAD, "1000", "1001"), ("time [min],speed [m/s]\n", "10", f"{10 + 1 / 60!r}")):
        simulation = Simulation(windy(), SCRIPT, [head, f"{first},4\n", f"{second},6\n", "2000,0\n"])
        simulation.step(5)
        assert load(simulation) == pytest.approx(8.0)
        simulation.step()
        assert load(simulation) == pytest.approx(18.0)


def test_the_run_ends_with_the_frame_in_which_the_stream_ends():
    """Rows to 0.5 s, frames of 0.2 s: the last frame is at 0.6 s, and running is its status."""
    frames = list(simulate(windy(), script=SCRIPT, stream=[HEAD, "0,4\n", "0.5,6\n"]))
    assert [round(f.time, 9) for f in frames] == [0, 0.2, 0.4, 0.6]
    assert frames[-1].status == "running"


def test_rows_are_read_when_they_are_needed_and_not_before():
    """Of a stream of a row each second, two rows are read for the frames up to 1 s: the one that acts and the next."""
    taken = []

    def lines():
        yield HEAD
        for second in range(100):
            taken.append(second)
            yield f"{second},4\n"

    frames = simulate(windy(), script=SCRIPT, stream=lines())
    next(frames)
    assert taken == [0]
    for _ in range(4):
        next(frames)
    assert taken == [0, 1]


def test_a_file_standard_input_and_lines_are_one_stream(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The same bits from each, a byte order mark and Windows line ends included."""
    lines = [HEAD, "0,4\n", "0.5,6\n", "1,2\n"]
    (tmp_path / "wind.csv").write_bytes(b"\xef\xbb\xbf" + "".join(lines).replace("\n", "\r\n").encode())
    monkeypatch.setattr("sys.stdin", io.StringIO("".join(lines)))
    last = [
        list(simulate(windy(), script=SCRIPT, stream=source))[-1].particles.tobytes()
        for source in (lines, tmp_path / "wind.csv", str(tmp_path / "wind.csv"), "-", Stream(lines))
    ]
    assert len(set(last)) == 1


def test_a_file_is_read_anew_on_reset_and_a_pipe_says_that_it_cannot(tmp_path: Path):
    """Reset keeps supports and plays the file from its first row, bit for bit."""
    (tmp_path / "wind.csv").write_text(HEAD + "0,4\n0.5,6\n1,2\n", encoding="utf-8")
    simulation = Simulation(windy(), SCRIPT, tmp_path / "wind.csv")
    simulation.step(4)
    first = simulation.state.x.tobytes()
    simulation.reset()
    assert simulation.state.free[[0, 5]].sum() == 0
    assert load(simulation) == pytest.approx(8.0)
    simulation.step(4)
    assert simulation.state.x.tobytes() == first
    piped = Simulation(windy(), SCRIPT, [HEAD, "0,4\n", "9,4\n"])
    piped.step()
    with pytest.raises(InputError, match="cannot be read twice"):
        piped.reset()


def test_a_saved_simulation_goes_on_with_its_stream(tmp_path: Path):
    """Rows before the saved time are passed over: the same bits as straight on."""
    (tmp_path / "wind.csv").write_text(HEAD + "0,4\n0.5,6\n1,2\n9,1\n", encoding="utf-8")
    straight = Simulation(windy(), SCRIPT, tmp_path / "wind.csv")
    straight.step(3)
    straight.save(tmp_path / "half.npz")
    resumed = Simulation.load(tmp_path / "half.npz", tmp_path / "wind.csv")
    for simulation in (straight, resumed):
        simulation.step(4)
    assert resumed.state.x.tobytes() == straight.state.x.tobytes()
    with pytest.raises(InputError, match="needs a stream; give one"):
        Simulation.load(tmp_path / "half.npz")


def test_more_columns_than_are_used_may_hold_anything():
    """A station's name, an empty gauge: only time and what drives name must be numbers."""
    lines = ["station,time [s],gauge [mm], speed [m/s] \n", "north,0,,4\n", "north,1,n/a,6\n"]
    assert [row.values["speed"] for row in Stream(lines).rows(["speed"])] == [4.0, 6.0]


ROW = "0,4\n"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([], "stream: is empty; the first line names columns"),
        ([HEAD], "stream: has no row"),
        (["time [s],wind [m/s]\n", ROW], "stream line 1: no column speed"),
        (["time [s];speed [m/s]\n", ROW], "stream line 1: no column time; there are .* .separated by commas"),
        (
            ["time [s],speed [km/h]\n", ROW],
            r"stream line 1: no column speed \[m/s\]; .* speed \[km/h\]",
        ),
        (["time [h],speed [m/s]\n", ROW], "stream line 1: time is in 'h'; one of ms, s, min"),
        (["time,time,speed [m/s]\n", ROW], "stream line 1: 2 columns have the name time"),
        ([HEAD, ROW, "1,calm\n"], "stream line 3: speed is 'calm'; give a finite number in m/s"),
        ([HEAD, ROW, "1,nan\n"], "stream line 3: speed is 'nan'"),
        ([HEAD, ROW, "1,inf\n"], "stream line 3: speed is 'inf'"),
        ([HEAD, ROW, "1,1_0\n"], "stream line 3: speed is '1_0'"),
        ([HEAD, ROW, "1,\n"], "stream line 3: speed is empty"),
        ([HEAD, ROW, "later,4\n"], "stream line 3: time is 'later'; give a finite number in s"),
        ([HEAD, ROW, "1\n"], "stream line 3: 1 value for 2 columns; give one for each of time, speed"),
        ([HEAD, ROW, "1,4,5\n"], "stream line 3: 3 values for 2 columns"),
        ([HEAD, ROW, "\n", "1,4\n"], "stream line 3: is empty"),
        ([HEAD, ROW, "0,5\n"], "stream line 3: time 0 is not after the row before"),
        ([HEAD, ROW, "-1,5\n"], "stream line 3: time -1 is not after the row before"),
        ([HEAD, ROW, "0.1,1e200\n", "9,0\n"], "stream line 3: 1e[+]200 to the power 2 is not a finite number"),
    ],
)
def test_a_wrong_row_is_told_by_its_line_and_loses_no_frame(lines: list[str], said: str):
    """One sentence; the frames before it were given."""
    frames = []
    with pytest.raises(InputError, match=said) as caught:
        frames.extend(simulate(windy(), script=SCRIPT, stream=lines))
    assert re.match(said, str(caught.value))
    assert "\n" not in str(caught.value)
    simulation = Simulation(windy(), SCRIPT, [HEAD, ROW, "0.5,4\n", "1,calm\n"])
    simulation.step(2)
    with pytest.raises(InputError, match="line 4"):
        simulation.step()
    assert simulation.state.time >= 0.5


def test_empty_lines_at_the_end_are_no_rows():
    """As editors leave them."""
    assert len(list(Stream([HEAD, ROW, "1,4\n", "\n", "\n"]).rows(["speed"]))) == 2


def test_a_value_that_its_force_does_not_take_is_told_by_its_line():
    """A stiffness below zero comes only with the row that says so."""
    drive = {"force": "cable", "column": "stiffness", "source": "k", "scale": 1000}
    with pytest.raises(InputError, match="stream line 3: /forces/cable/stiffness -1000 given; at least 0 allowed"):
        list(simulate(windy(), script={"drives": [drive]}, stream=["time,k\n", "0,1\n", "0.1,-1\n", "9,1\n"]))


def test_a_file_that_cannot_be_read_is_told(tmp_path: Path):
    """Not there, or no text: the file's name and why."""
    with pytest.raises(InputError, match=r"gone\.csv: cannot be read \(No such file"):
        Simulation(windy(), SCRIPT, tmp_path / "gone.csv")
    (tmp_path / "latin.csv").write_bytes(b"time [s],speed [m/s]\n0,4\n1,\xe9\n")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        list(simulate(windy(), script=SCRIPT, stream=tmp_path / "latin.csv"))


@pytest.mark.parametrize(
    ("drive", "pointer"),
    [
        (DRIVE | {"force": "gale"}, "/drives/0/force"),
        (DRIVE | {"column": "vectr"}, "/drives/0/column"),
        (DRIVE | {"scale": [1, 2]}, "/drives/0/scale"),
        (DRIVE | {"power": -1}, "/drives/0/power"),
    ],
)
def test_a_drive_that_does_not_fit_says_where(drive: dict, pointer: str):
    """Before the first row is used."""
    with pytest.raises(InputError) as caught:
        Simulation(windy(), {"drives": [drive]}, [HEAD, ROW])
    assert caught.value.pointer == pointer


def test_a_stream_without_drives_and_drives_without_a_stream_are_told():
    """Either alone would do nothing."""
    with pytest.raises(InputError, match="no drive uses it"):
        Simulation(windy(), None, [HEAD, ROW])
    with pytest.raises(InputError, match="needs a stream; give one"):
        Simulation(windy(), SCRIPT)
