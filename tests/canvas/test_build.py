"""What a person installs: user objects and packages, read back from the files that were written."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hookean
from canvas.archives import SHARED, user_objects
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, guids
from hookean_canvas.archive.parts import code
from hookean_canvas.command import app
from hookean_canvas.components import build, bundles, inline, userobject, yak
from hookean_canvas.inspect import lint
from serving import HANG
from soak import sampled

ROOT = Path(__file__).parents[2]
BUNDLES = {bundle.folder: bundle for bundle in bundles.read_all()}
every_bundle = pytest.mark.parametrize("name", sampled(BUNDLES, 4))


@pytest.fixture(scope="module")
def dist(tmp_path_factory) -> Path:
    """Everything built once."""
    folder = tmp_path_factory.mktemp("dist")
    build.build(folder)
    return folder


def opened(dist: Path, flavour: str, name: str) -> tuple[Chunk, Chunk]:
    """A user object and the component in it."""
    outer = archive.read(dist / flavour / f"Hookean_{name}.ghuser")
    return outer, archive.of_bytes(outer.value("Object"))


def shape(chunk: Chunk) -> dict[str, str]:
    """Names and types of the items of a chunk, indices left out."""
    return {item.name: item.type.name for item in chunk.items}


@pytest.mark.soak
def test_building_some_again_gives_the_same_bytes(dist, tmp_path):
    """User objects from another process: no date, no chance, no order of files or hashed strings."""
    told = (
        "import sys; from pathlib import Path; from hookean_canvas.components.build import build;"
        "from hookean_canvas.components.bundles import read_all; build(Path(sys.argv[1]), read_all()[::20])"
    )
    command, environment = [sys.executable, "-c", told, str(tmp_path)], {**os.environ, "PYTHONHASHSEED": "7"}
    subprocess.run(command, env=environment, check=True, timeout=HANG)
    made = sorted(tmp_path.rglob("*.ghuser"))
    assert len(made) > 8
    for path in made:
        assert path.read_bytes() == (dist / path.relative_to(tmp_path)).read_bytes(), path.name


@pytest.mark.soak
def test_building_again_gives_the_same_bytes(dist, tmp_path):
    """User objects and packages, from another process: no date, no chance, no order of files or hashed strings."""
    told = "import sys; from hookean_canvas.command import app; app(['build', '--output', sys.argv[1]])"
    command, environment = [sys.executable, "-c", told, str(tmp_path)], {**os.environ, "PYTHONHASHSEED": "7"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    assert f"{len(BUNDLES)} components" in done.stdout
    files = sorted(p.relative_to(dist) for p in dist.rglob("*") if p.is_file())
    assert files == sorted(p.relative_to(tmp_path) for p in tmp_path.rglob("*") if p.is_file())
    for name in files:
        assert (tmp_path / name).read_bytes() == (dist / name).read_bytes(), name


@pytest.mark.soak
def test_each_rhino_gets_the_components_it_can_run(dist):
    """Rhino 8 and 9 all of them; Rhino 7 those that ask for no packages."""
    found = {f: {p.stem.removeprefix("Hookean_") for p in (dist / f).iterdir()} for f in ("rhino8", "rhino7")}
    assert found["rhino8"] == set(BUNDLES)
    assert found["rhino7"] == {name for name, bundle in BUNDLES.items() if not bundle.rhino8_only}
    assert {"Engine", "Springs", "Unary"} <= found["rhino7"]


@pytest.mark.thinned
@every_bundle
@pytest.mark.parametrize("flavour", ["rhino8", "rhino7"])
def test_a_user_object_says_what_its_bundle_says(dist, name, flavour):
    """Names, panel, icon and inputs are the bundle's, the code is its code with the client inside; no faults."""
    bundle = BUNDLES[name]
    if not build.fits(bundle, flavour):
        assert not (dist / flavour / f"Hookean_{name}.ghuser").exists()
        return
    outer, inner = opened(dist, flavour, name)
    assert lint.faults(outer) == []
    told = [outer.value(key) for key in ("Name", "NickName", "Category", "SubCategory", "Description", "Icon")]
    assert told == [bundle.name, bundle.nickname, "Hookean", bundle.subcategory, bundle.description, bundle.icon]
    assert outer.value("BaseID") == userobject.BASES[flavour]
    found = code(inner)
    assert found is not None
    assert found.text == inline.inlined(bundle.code, flavour)
    assert found.language == ("python 3" if flavour == "rhino8" else "python 2")
    data = inner.chunk("ParameterData")
    assert data is not None
    hints = guids.HINTS if flavour == "rhino8" else guids.HINTS_IRONPYTHON
    for side, parameters in (("Input", bundle.inputs), ("Output", bundle.outputs)):
        written = [chunk for chunk in data.chunks if chunk.name == f"{side}Param"]
        for chunk, parameter in zip(written, parameters, strict=True):
            assert chunk.value("NickName") == chunk.value("Name") == parameter.name
            assert chunk.value("Description") == parameter.description
            if side == "Input":
                assert chunk.value("ScriptParamAccess") == parameter.access
                assert chunk.value("TypeHintID") == hints[parameter.hint]


def test_no_id_is_given_twice(dist):
    """User objects of both flavours and their inputs and outputs: one Grasshopper may load them all."""
    found = []
    for path in dist.rglob("*.ghuser"):
        outer = archive.read(path)
        inner = archive.of_bytes(outer.value("Object"))
        found += [c.value("InstanceGuid") for c in (outer, *inner.walk()) if c.item("InstanceGuid")]
    assert len(found) == len(set(found)) > 100


def test_a_rhino_7_component_is_laid_out_like_those_of_compas(dist):
    """The same items of the same types, outside, inside and on inputs and outputs, as compas' own user objects."""
    outer, inner = opened(dist, "rhino7", "Springs")
    for path in user_objects("compas"):
        theirs = archive.read(path)
        if theirs.value("BaseID") != guids.GHPYTHON_SCRIPT:
            continue
        content = archive.of_bytes(theirs.value("Object"))
        assert shape(outer) == shape(theirs)
        assert shape(inner) == shape(content)
        ours, other = inner.chunk("ParameterData"), content.chunk("ParameterData")
        assert ours is not None and other is not None
        for kind in ("InputParam", "OutputParam"):
            for there in (chunk for chunk in other.chunks if chunk.name == kind):
                assert shape(next(c for c in ours.chunks if c.name == kind)) == {
                    k: v for k, v in shape(there).items() if k != "Mapping"
                }
        return
    pytest.skip("the installed compas carries no user object for GhPython")


@pytest.mark.skipif(not SHARED.is_dir(), reason="the shared folder with a user object saved by Rhino 8 is absent")
def test_a_rhino_8_component_has_the_types_that_rhino_8_writes(dist):
    """Items that the sample has too are of the same type; the sample is of a generic script, an older schema."""
    outer, inner = opened(dist, "rhino8", "Springs")
    sample = archive.read(SHARED / "TestUserObjectCpy.ghuser")
    content = archive.of_bytes(sample.value("Object"))
    assert shape(sample).items() <= shape(outer).items()
    least = {"Description", "IconOverride", "Name", "UsingStandardOutputParam"}, {"Text", "Title"}
    chunks = (inner, content), (inner.chunk("Script"), content.chunk("Script"))
    for (ours, theirs), names in zip(chunks, least, strict=True):
        assert ours is not None and theirs is not None
        common = shape(ours).keys() & shape(theirs).keys()
        assert names <= common
        assert {k: shape(ours)[k] for k in common} == {k: shape(theirs)[k] for k in common}
    script = inner.chunk("Script")
    assert script is not None
    language = script.chunk("LanguageSpec")
    assert language is not None
    assert (language.value("Taxon"), language.value("Version")) == ("*.*.python", "3.*")
    assert inner.value("ScriptComponentVersion") == 3


@pytest.mark.parametrize(("tag", "flavour"), [("rh8-any", "rhino8"), ("rh7-any", "rhino7")])
def test_a_package_is_a_zip_with_a_manifest(dist, tag, flavour):
    """manifest.yml and the user objects at the top, as they stand in the folder; name and version of the project."""
    with zipfile.ZipFile(dist / f"hookean-{hookean.__version__}-{tag}.yak") as package:
        assert package.testzip() is None
        content = {name: package.read(name) for name in package.namelist()}
        assert {entry.date_time for entry in package.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    manifest = content.pop("manifest.yml").decode("utf-8")
    icon = content.pop("icon.png")
    assert icon == BUNDLES["Engine"].icon
    assert content == {p.name: p.read_bytes() for p in (dist / flavour).glob("*.ghuser")}
    said = dict(re.findall(r"(?m)^(\w+): (.+)$", manifest))
    assert (said["name"], said["version"]) == ("hookean", hookean.__version__)
    assert json.loads(said["description"]) == build.DESCRIPTION
    assert re.search(r"(?m)^authors:\n  - \S", manifest)


@pytest.mark.parametrize("version", ["1.0", "1.0.0rc1", "v1.0.0"])
def test_a_version_that_the_package_manager_refuses_is_told(version):
    """Semantic versions only."""
    with pytest.raises(InputError, match="not a semantic version"):
        yak.manifest(version, "words")


def test_what_was_built_before_is_gone(tmp_path):
    """A component that is no more leaves no file; other files in the folder stay."""
    (tmp_path / "rhino8").mkdir()
    for name in ("Hookean_Gone.ghuser", "notes.txt"):
        (tmp_path / "rhino8" / name).write_text("")
    build.build(tmp_path, [BUNDLES["Unary"]])
    assert {p.name for p in (tmp_path / "rhino8").iterdir()} == {"Hookean_Unary.ghuser", "notes.txt"}


def test_a_component_that_does_not_pass_the_checks_is_not_written(tmp_path, monkeypatch):
    """The sentence names the component, the flavour and the faults; nothing to build is told too."""
    monkeypatch.setattr(lint, "faults", lambda chunk: ["an input has no name"])
    with pytest.raises(InputError, match=r"Unary \(rhino8\): an input has no name"):
        build.build(tmp_path, [BUNDLES["Unary"]])
    assert not list(tmp_path.rglob("*.ghuser"))
    with pytest.raises(InputError, match="nothing to build"):
        build.build(tmp_path, [])


@pytest.fixture
def few(monkeypatch):
    """Three of the bundles stand for all."""
    monkeypatch.setattr(build, "read_all", lambda: [BUNDLES[name] for name in ("Springs", "Unary", "CompasRelax")])


def test_the_command_builds_and_says_where(few, tmp_path):
    """`hookean canvas build --output`: a line for each folder and package."""
    done = CliRunner().invoke(app, ["build", "--output", str(tmp_path / "new")])
    assert done.exit_code == 0, done.output
    assert "rhino8: 3 components" in done.output and "rhino7: 2 components" in done.output
    assert len(list((tmp_path / "new").glob("*.yak"))) == 2


def test_installing_replaces_only_our_own_files(few, tmp_path):
    """`hookean canvas install --folder`: user objects in a folder of their own, what others put there stays."""
    (tmp_path / "Hookean").mkdir()
    for path in (tmp_path / "other.ghuser", tmp_path / "Hookean" / "mine.ghuser"):
        path.write_text("mine")
    (tmp_path / "Hookean" / "Hookean_Gone.ghuser").write_text("old")
    for rhino, base in (("9", guids.PYTHON3_SCRIPT), ("7", guids.GHPYTHON_SCRIPT)):
        done = CliRunner().invoke(app, ["install", "--rhino", rhino, "--folder", str(tmp_path)])
        assert done.exit_code == 0, done.output
        assert archive.read(tmp_path / "Hookean" / "Hookean_Springs.ghuser").value("BaseID") == base
    assert (tmp_path / "other.ghuser").read_text() == (tmp_path / "Hookean" / "mine.ghuser").read_text() == "mine"
    assert not (tmp_path / "Hookean" / "Hookean_Gone.ghuser").exists()


def test_user_objects_are_where_each_system_has_them(tmp_path):
    """Windows: one folder for every Rhino. Mac: one each, in the plug-in's settings. Elsewhere: none is known."""
    for rhino in (7, 8):
        windows = build.user_objects_folder(rhino, "win32", {"APPDATA": "/appdata"})
        assert windows == Path("/appdata/Grasshopper/UserObjects")
    mac = build.user_objects_folder(8, "darwin", {"HOME": "/home"})
    assert mac is not None and "/Rhinoceros/8.0/Plug-ins/Grasshopper (b45a29b1" in mac.as_posix()
    assert build.user_objects_folder(8, "linux", {"HOME": "/home"}) is None


@pytest.mark.parametrize("folder", [None, "absent"])
def test_without_grasshopper_the_sentence_says_where_to_put_them(tmp_path, monkeypatch, folder):
    """Exit code 2 and one line with the menu that opens the folder."""
    monkeypatch.setattr(build, "user_objects_folder", lambda rhino: None)
    given = ["--folder", str(tmp_path / folder)] if folder else []
    done = CliRunner().invoke(app, ["install", *given])
    assert done.exit_code == 2
    assert "File > Special Folders > User Object Folder" in done.output
    assert len(done.output.strip().splitlines()) == 1


@pytest.mark.soak
def test_an_installed_wheel_can_build(tmp_path):
    """The wheel carries bundles and client; built from it alone, a component is the same as from the tree."""
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    from hatchling.builders.wheel import WheelBuilder

    wheel = next(WheelBuilder(str(ROOT)).build(directory=str(tmp_path / "wheel"), versions=["standard"]))
    with zipfile.ZipFile(wheel) as archive_:
        archive_.extractall(tmp_path / "site")
    told = (
        f"import sys; sys.path.insert(0, {str(tmp_path / 'site')!r}); import hookean_canvas.components.build as b;"
        "from pathlib import Path; from hookean_canvas.components import bundles;"
        f"print(bundles.folder()); b.build(Path({str(tmp_path / 'dist')!r}), [bundles.read('Springs')])"
    )
    done = subprocess.run([sys.executable, "-c", told], cwd=tmp_path, capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str(tmp_path / "site" / "hookean_canvas" / "component_sources")
    written = (tmp_path / "dist" / "rhino8" / "Hookean_Springs.ghuser").read_bytes()
    assert written == archive.to_bytes(userobject.user_object(BUNDLES["Springs"]))
