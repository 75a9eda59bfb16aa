"""The force components are what the force classes say, and every bundle has the icon drawn for it."""

from __future__ import annotations

import importlib.util
import io
import json
import subprocess
import sys
import types
from pathlib import Path

import pytest

from canvas import isolated
from canvas.wired import ENTRIES, inputs
from hookean.forces import KINDS
from hookean_canvas.components import bundles, force_bundles, icons, inline
from hookean_canvas.run import stand_in
from serving import HANG

COMPONENTS = Path(__file__).parents[2] / "components"
every_force = pytest.mark.parametrize("kind", list(KINDS))


@pytest.fixture
def generate():
    """components/generate.py as a module."""
    spec = importlib.util.spec_from_file_location("generate_components", COMPONENTS / "generate.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def copied(to: Path) -> Path:
    for folder in COMPONENTS.iterdir():
        if (folder / "metadata.json").is_file():
            (to / folder.name).mkdir()
            for name in bundles.FILES:
                if (folder / name).is_file():
                    (to / folder.name / name).write_bytes((folder / name).read_bytes())
    return to


def test_running_the_generator_again_changes_nothing(generate, capsys):
    """What is in the tree is what the classes and drawings of today give."""
    assert generate.main(["--check"]) == 0, capsys.readouterr().out


def test_the_generator_writes_the_same_bytes_from_nothing(generate, monkeypatch, tmp_path):
    """Twice into an empty folder: the same files with the same bytes."""
    found = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        monkeypatch.setattr(generate, "HERE", tmp_path / name)
        assert generate.main([]) == 0
        found.append({p.relative_to(tmp_path / name): p.read_bytes() for p in (tmp_path / name).rglob("*.*")})
    assert found[0] == found[1]
    assert len(found[0]) == 3 * len(KINDS)


@pytest.mark.slow
@pytest.mark.parametrize(
    "spoil",
    [
        lambda place: (place / "Springs" / "code.py").unlink(),
        lambda place: (place / "Unary" / "metadata.json").write_text("{}"),
        lambda place: (place / "Shell" / "icon.png").write_bytes(icons.png("Hinge")),
    ],
    ids=["lost", "edited", "other icon"],
)
def test_a_stale_bundle_is_seen_and_mended(generate, monkeypatch, tmp_path, spoil):
    """--check exits with 1 and writes nothing; without it the bundle is as before."""
    place = copied(tmp_path)
    monkeypatch.setattr(generate, "HERE", place)
    whole = {p: p.read_bytes() for p in place.rglob("*.*")}
    spoil(place)
    assert generate.main(["--check"]) == 1
    assert {p: p.read_bytes() for p in place.rglob("*.*")} != whole
    assert generate.main([]) == 0
    assert {p: p.read_bytes() for p in place.rglob("*.*")} == whole


def test_a_new_force_without_a_bundle_is_seen(generate, monkeypatch, capsys):
    """A class added to the forces has a component once the generator has run, and a check says so before."""
    found = force_bundles.files()
    monkeypatch.setattr(force_bundles, "files", lambda: {**found, "Gust": found["Unary"]})
    assert generate.main(["--check"]) == 1
    assert "Gust/code.py differs" in capsys.readouterr().out


def test_every_force_has_a_component_and_no_other_is_there():
    """The panel Forces holds the classes of core/hookean/forces, neither more nor fewer."""
    shipped = {b.folder for b in bundles.read_all() if b.subcategory == "Forces"}
    assert shipped == {cls.__name__ for cls in KINDS.values()}


@every_force
def test_every_field_has_an_input_or_a_reason(kind):
    """Fields without an input are listed with why; inputs feed fields that the class has."""
    fed = {entry.field for entry in force_bundles.entries(ENTRIES[kind])}
    covered = {*force_bundles.COVERED[""], *force_bundles.COVERED.get(kind, ())} & set(KINDS[kind].model_fields)
    assert fed | covered | {"kind"} == set(KINDS[kind].model_fields)
    assert not fed & covered


@every_force
def test_the_code_gives_every_input_to_its_field(kind, monkeypatch):
    """Run with a recorder for `canvas`: every variable arrives once, under the name of a field of the class."""
    taken = {}

    def force(ghenv, kind, **fields):
        taken.update(fields, kind=kind, ghenv=ghenv)
        return "the force"

    client = types.ModuleType("hookean_client")
    client.canvas = types.SimpleNamespace(force=force)
    monkeypatch.setitem(sys.modules, "hookean_client", client)
    bundle = bundles.read(KINDS[kind].__name__)
    space = {parameter.name: f"<{parameter.name}>" for parameter in bundle.inputs} | {"ghenv": "here"}
    exec(compile(bundle.code, "code.py", "exec"), space)
    assert space["force"] == "the force"
    assert taken.pop("kind") == kind
    assert taken.pop("ghenv") == "here"
    assert set(taken) <= set(KINDS[kind].model_fields)
    values = [v for value in taken.values() for v in (value if isinstance(value, tuple) else [value])]
    assert sorted(values) == sorted(f"<{p.name}>" for p in bundle.inputs)


@every_force
def test_the_help_says_the_formula_and_every_number_its_unit(kind):
    """Formula in the description and the docstring; unit and default in every tooltip; names say what is required."""
    entry, bundle = ENTRIES[kind], bundles.read(KINDS[kind].__name__)
    assert entry["formula"] in bundle.description
    assert force_bundles.ascii_text(entry["formula"]) in bundle.code
    fields = {field["name"]: field for field in entry["fields"]}
    for made, shown in zip(force_bundles.entries(entry), bundle.inputs, strict=True):
        field = fields[made.field]
        assert (shown.name, shown.access) == (made.variable, 1)
        if "number" in field["type"] or "vector" in field["type"] or field["unit"] != "-":
            assert "[" in shown.description, shown.name
        if field["default"] not in (None, ""):
            assert "Default: " in shown.description
            assert shown.name.startswith("_") and shown.name.endswith("_")
        if field["required"]:
            assert shown.name.startswith("_") and not shown.name.endswith("_")


def test_inputs_come_as_a_kangaroo_user_expects_them():
    """Order and names of Kangaroo 0.099's components come first; what it does not have follows."""
    expected = {
        "Springs": "_connection _stiffness_ _damping_ rest_length_ _upper_cutoff_ _lower_cutoff_ _plasticity_",
        "Unary": "_point _force",
        "Shell": "_mesh _strength_ _angle_factor_",
        "Hinge": "_point_1 _point_2 _point_3 _point_4 _strength_ rest_angle_",
        "Bend": "_point_1 _point_2 _point_3 _stiffness_ rest_angle_",
        "Pressure": "_mesh _pressure_",
        "PullToCurve": "_curve _point _strength_",
        "PullToMesh": "_target _point _strength_",
        "AnchorSpring": "_point _strength_",
    }
    for folder, names in expected.items():
        found = [parameter.name for parameter in bundles.read(folder).inputs]
        assert found[: len(names.split())] == names.split()
    assert [(b.name, b.nickname) for b in map(bundles.read, ("Springs", "Unary"))] == [
        ("Springs From Line", "Springs"),
        ("Unary Force", "UForce"),
    ]


GIVEN = {cls.__name__: inputs(kind) for kind, cls in KINDS.items()}


@pytest.fixture(scope="module")
def sent() -> dict[str, dict[str, object]]:
    """What the built force components put on their wires for `GIVEN`, by their folders."""
    steps = []
    for name, given in GIVEN.items():
        bundle = bundles.read(name)
        inputs = {p.name: given.get(p.name) for p in bundle.inputs}
        assert set(given) <= set(inputs)
        steps.append({"name": name, "code": inline.inlined(bundle.code), "inputs": inputs, "outputs": ["force"]})
    command = [sys.executable, "-I", isolated.__file__, stand_in.__file__]
    done = subprocess.run(command, input=json.dumps({"steps": steps}), capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    answers = dict(zip(GIVEN, json.loads(done.stdout), strict=True))
    assert {name: a["messages"] for name, a in answers.items()} == {name: [] for name in GIVEN}
    return {name: json.loads(answer["outputs"]["force"]) for name, answer in answers.items()}


@every_force
def test_what_a_component_sends_is_a_force_of_its_class(kind, sent):
    """Every class takes what its component puts on the wire, and finds in it what was connected."""
    name = KINDS[kind].__name__
    force = {key: value for key, value in sent[name].items() if key != "source"}
    if "mesh" in force:
        force["mesh"] = "the engine names it"
    found = KINDS[kind].model_validate(force)
    fields = {e.variable: e.field for e in force_bundles.entries(ENTRIES[kind])}
    numbers = {fields[v]: g for v, g in GIVEN[name].items() if isinstance(g, list) and isinstance(g[0], float | str)}
    for field, values in numbers.items():
        told = getattr(found, field)
        if field in ("image", "path"):
            rows = [[float(number) for number in row.split(",")] for row in values]
            assert told.tolist() == rows
            continue
        assert (told.tolist() if hasattr(told, "tolist") else [told]) in (values, values[0])


def test_names_are_known_to_the_tables():
    """The tables of the generator speak of forces and fields that exist."""
    for table in (force_bundles.FAMILIAR, force_bundles.ORDER):
        assert set(table) <= set(KINDS)
    for kind, names in {**force_bundles.COVERED, **{k: v.split() for k, v in force_bundles.ORDER.items()}}.items():
        assert set(names) <= (
            {f for c in KINDS.values() for f in c.model_fields} if not kind else KINDS[kind].model_fields.keys()
        )
    assert {kind for kind, _ in force_bundles.TOLD} <= set(KINDS)
    assert all(field in KINDS[kind].model_fields for kind, field in force_bundles.TOLD)


def test_formulas_are_written_in_ascii_where_python_2_reads_them():
    """Greek letters by name, powers with ^, also those nobody listed."""
    assert force_bundles.ascii_text("E = EI (φ - φ0)²/2, μ ≥ 0") == "E = EI (phi - phi0)^2/2, mu >= 0"
    assert force_bundles.ascii_text("λ") == "lamda"


def test_icons_are_small_transparent_and_each_its_own():
    """24 x 24 with an alpha channel, not empty, no two alike; a name without a drawing gets its letters."""
    from PIL import Image

    found = {bundle.folder: bundle.icon for bundle in bundles.read_all()}
    assert len(set(found.values())) == len(found)
    for name, data in found.items():
        assert icons.same_picture(data, icons.png(name)), name
        with Image.open(io.BytesIO(data)) as image:
            assert image.size == (24, 24) and image.mode == "RGBA"
            alpha = image.getchannel("A").tobytes()
        assert 0 in alpha and sum(a > 128 for a in alpha) > 20
    assert icons.png("WindLoad") == icons.png("WindLoad") != icons.png("Vortex")
    assert not icons.same_picture(icons.png("WindLoad"), icons.png("Vortex"))


def test_metadata_is_what_componentizers_read():
    """The keys of compas' componentizer, with ids that stay."""
    text = json.loads((COMPONENTS / "Springs" / "metadata.json").read_text(encoding="utf-8"))
    assert {"name", "nickname", "category", "subcategory", "description", "exposure", "instanceGuid"} < set(text)
    assert text["instanceGuid"] == str(bundles.identity("Springs")) == "2917b760-6b7a-5ac3-af31-343754eae608"
    assert text["ghpython"]["inputParameters"][0]["scriptParamAccess"] == "list"
