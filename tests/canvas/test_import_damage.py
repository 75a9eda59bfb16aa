"""Damaged and cut files through `hookean canvas import`: a translation or one sentence, never a traceback."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from canvas.archives import SHARED
from canvas.kangaroo_samples import Kangaroo, cable, star, tent
from hookean_canvas import archive
from hookean_canvas.archive import Type
from hookean_canvas.archive.binary import deflate, to_plain
from hookean_canvas.command import app
from hookean_canvas.kangaroo.ids import COMPONENTS
from soak import SOAK

CASES = 2000 if SOAK else 30
shell = CliRunner()


def meshes() -> Kangaroo:
    """Goals that get helpers: volumes, pairs of lines, points by number, planes."""
    d = Kangaroo("meshes", "Meshes", "Goals with helpers.")
    mesh, data = d.parameter("Mesh", "Mesh"), d.parameter("Data", "Data")
    volume = (("Mesh", None), ("Volume", 2.0), ("Strength", 3.0))
    snap = (("LineA", None), ("LineB", None), ("Factor", 1.5), ("Strength", 3.0))
    plane = (("Points", None), ("Plane", None), ("Strength", 3.0))
    d.solved(
        d.kangaroo("Volume", volume, ["V"], mesh=mesh),
        d.kangaroo("AngleSnap", snap, ["A"], linea=data, lineb=data),
        d.kangaroo("OnPlane", plane, ["P"], points=data, plane=data),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, 1.0))), ["U"], p=data),
    )
    return d


def inside() -> Kangaroo:
    """A cluster with a bar of K2Engineering, whose output is taken apart behind the solver."""
    inner = Kangaroo("inner", "Inner", "A bar.")
    hooks = [inner.parameter("Data", "Lines")]
    named = {known.name: guid for guid, known in COMPONENTS.items() if known.generation == "engineering"}
    typed = (("Line", None), ("E-Modulus", 210000.0), ("Area", 100.0))
    bar = inner.kangaroo("Bar", typed, ["B"], guid=named["Bar"], line=hooks[0])
    hooks.append(inner.parameter("Data", "Bars", source=bar))
    for made, side in zip(hooks, ("Input", "Output"), strict=True):
        made.container.items = [item for item in made.container.items if item.name != "Name"]
        made.container.put("Name", Type.STRING, f"Cluster {side}")
    d = Kangaroo("outer", "Outer", "A bar in a cluster.")
    cluster = d.cluster("Bars", archive.to_bytes(inner.archive()), d.parameter("Line", "Line"))
    solver = d.solved(cluster)
    given = (("BarData", None),)
    d.kangaroo("BarOutput", given, ["Line", "AxialForce"], guid=named["BarOutput"], bardata=solver["O"])
    return d


SAMPLES: list[Callable[[], Kangaroo]] = [cable, star, tent, meshes, inside]
FORMS = ("xml", "packed", "plain")


@cache
def sound(which: int, form: str) -> bytes:
    """A file of ours before it is damaged; `plain`: a binary archive that is packed after the damage."""
    root = SAMPLES[which]().archive()
    return {"xml": archive.to_xml, "packed": archive.to_bytes, "plain": to_plain}[form](root)


def damaged(data: bytes, seed: int) -> bytes:
    """Some bytes changed, cut out, doubled, moved or put in; or the end is gone."""
    pick, changed = random.Random(seed), bytearray(data)
    for _ in range(pick.choice((1, 1, 1, 2, 5, 20))):
        at, size = pick.randrange(len(changed) + 1), pick.choice((1, 1, 2, 4, 16, 200))
        part = bytes(changed[at : at + size])
        way = pick.randrange(6)
        if way == 0:
            changed[at : at + size] = pick.randbytes(len(part))
        elif way == 1:
            del changed[at : at + size]
        elif way == 2:
            changed[at:at] = part
        elif way == 3:
            changed[at:at] = pick.randbytes(pick.choice((1, 4, 16)))
        elif way == 4 and part:
            changed[at] = changed[at] ^ (1 << pick.randrange(8))
        elif way == 5:
            other = pick.randrange(len(changed) + 1)
            changed[other : other + len(part)] = part
    return bytes(changed[: pick.randrange(len(changed) + 1)] if pick.randrange(5) == 0 else changed)


def imported(data: bytes, suffix: str) -> int:
    """The exit code of the command for a file with these bytes, after the checks that every one has to pass."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / f"form{suffix}", Path(folder) / "form-hookean.ghx"
        source.write_bytes(data)
        found = shell.invoke(app, ["import", str(source)])
        assert found.exception is None or isinstance(found.exception, SystemExit), found.exception
        assert found.exit_code in (0, 2) and "Traceback" not in found.output
        if found.exit_code == 2:
            assert found.stderr.count("\n") == 1 and not target.exists()
            assert any(place in found.stderr for place in ("form", "Root")), found.stderr
        else:
            archive.read(target)
    return found.exit_code


@pytest.mark.soak
@settings(max_examples=CASES, deadline=None)
@given(st.integers(0, len(SAMPLES) - 1), st.sampled_from(FORMS), st.integers(0, 2**32 - 1))
@example(2, "xml", 0)
def test_damaged_files_are_translated_or_refused_in_a_sentence(which: int, form: str, seed: int) -> None:
    data = damaged(sound(which, form), seed)
    imported(deflate(data) if form == "plain" else data, ".ghx" if form == "xml" else ".gh")


@pytest.mark.parametrize("form", ["xml", "packed"])
def test_every_cut_file_is_refused(form: str) -> None:
    data = sound(1, form)
    steps = 400 if SOAK else 15
    for cut in range(steps):
        assert imported(data[: (len(data.rstrip()) - 1) * cut // steps], ".gh") == 2


def test_files_that_grasshopper_saved_are_damaged_in_the_same_ways() -> None:
    files = sorted(SHARED.glob("*.gh"))
    if not files:
        pytest.skip(f"no files of Grasshopper's own in {SHARED}")
    plain = to_plain(archive.read(files[0]))
    codes = {imported(deflate(damaged(plain, seed)), ".gh") for seed in range(200 if SOAK else 10)}
    assert 2 in codes
    assert imported(files[0].read_bytes(), ".gh") == 0
