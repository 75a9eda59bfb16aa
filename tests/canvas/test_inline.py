"""Scripts with the client inside: they need nothing, and versions do not disturb each other."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hookean.errors import InputError
from hookean_canvas.components import bundles, inline
from hookean_canvas.definitions.write import Definition
from pythons import interpreter

CODE = '"""Help."""\n\nimport hookean_client\nfrom hookean_client import Problem, canvas\n\nname = canvas.__name__\n'
CLIENT = Path(__file__).parents[2] / "components" / "hookean_client"
PYTHONS = ("2.7", "3.9", "3.13")  # of Rhino 7 as far as it goes, Rhino 8 and Rhino 9


def python(version: str) -> str:
    """An interpreter of that version; the test is skipped where there is none."""
    found = interpreter(version)
    if found is None:
        pytest.skip(f"this machine has no Python {version}")
    return found


def run(version: str, code: str, folder: Path) -> str:
    """What a script prints, run alone in an empty folder, with nothing of ours to import."""
    script = folder / "script.py"
    script.write_text(code, encoding="ascii")
    alone = ["-I"] if version != "2.7" else ["-E", "-s"]
    done = subprocess.run(
        [python(version), *alone, str(script)], cwd=folder, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def client(folder: Path, version: str, extra: str = "") -> Path:
    """A small client of that version, with a module that counts."""
    folder.mkdir()
    (folder / "__init__.py").write_text(f'__version__ = "{version}"\n{extra}')
    (folder / "counts.py").write_text("from . import more\n\ncount = []\n")
    (folder / "more.py").write_text(f"from hookean_client import __version__ as said\n\nmine = said == '{version}'\n")
    return folder


COUNTING = '"""Help."""\nfrom hookean_client import counts, more\ncounts.count.append(1)\nfound = len(counts.count)\n'


@pytest.mark.parametrize(
    ("flavour", "version"), [(f, v) for f in inline.FLAVOURS for v in PYTHONS if (f, v) != ("rhino8", "2.7")]
)
def test_a_script_needs_nothing_installed(flavour, version, tmp_path):
    """The client arrives under a name of its own, whole, and the component's help stays in front."""
    said = run(version, inline.inlined(CODE, flavour) + "print(name)\nprint(__doc__)\n", tmp_path).split("\n")
    assert said[:2] == [f"{inline.stamp()}.canvas", "Help."]
    assert re.fullmatch(r"hookean_client_0_1_0_[0-9a-f]{12}", inline.stamp())


@pytest.mark.thinned
@pytest.mark.parametrize("name", bundles.names())
def test_every_shipped_script_compiles_for_rhino_8_and_keeps_its_help(name):
    """With the syntax of Python 3.9, in both flavours, ASCII throughout, with only the first line between them."""
    code = bundles.read(name).code
    new, old = inline.inlined(code, "rhino8"), inline.inlined(code, "rhino7")
    for text in (new, old):
        assert text.isascii()
        tree = ast.parse(text, feature_version=(3, 9))
        assert ast.get_docstring(tree) == ast.get_docstring(ast.parse(code))
        assert max(map(len, text.splitlines())) <= 120
    packed = [re.sub(r'""" *\n[^ "]{60,}"""|b(64|85)decode| +', "", one) for one in (new, old)]
    assert packed[0] == "#!python3\n" + packed[1]
    assert new == inline.inlined(code, "rhino8")


def test_comments_in_front_and_future_imports_keep_their_place(tmp_path):
    """`# r:` is read from the head, a docstring is one only in front, `__future__` has to come before other code."""
    code = '# r: compas\n"""Help."""\nfrom __future__ import division\n\nfrom hookean_client import Problem\n'
    text = inline.inlined(code, "rhino8")
    assert text.splitlines()[:4] == ["#! python 3", "# r: compas", '"""Help."""', "from __future__ import division"]
    assert ast.get_docstring(ast.parse(text)) == "Help."
    run("3.9", text, tmp_path)


def test_state_stays_from_run_to_run_and_versions_live_side_by_side(tmp_path):
    """The same client is loaded once in a process; another version has modules and state of its own."""
    scripts = [inline.inlined(COUNTING, "rhino7", client(tmp_path / v, v)) for v in ("1.0.0", "1.1.0")]
    found = []
    before = set(sys.modules)
    try:
        for script in (scripts[0], scripts[0], scripts[1], scripts[0]):
            space: dict[str, object] = {}
            exec(compile(script, "script", "exec"), space)
            found.append((space["found"], space["more"].mine))  # type: ignore[attr-defined]
        loaded = sorted(set(sys.modules) - before)
    finally:
        for name in set(sys.modules) - before:
            del sys.modules[name]
    assert found == [(1, True), (2, True), (1, True), (3, True)]
    assert len(loaded) == 6 and "hookean_client" not in loaded


def test_a_client_that_fails_to_load_leaves_nothing_behind(tmp_path):
    """The next solution tries again, and fails the same way."""
    place = client(tmp_path / "client", "1.0.0")
    (place / "counts.py").write_text("raise RuntimeError('no luck')\n")
    script = inline.inlined(COUNTING, "rhino7", place)
    before = set(sys.modules)
    for _ in range(2):
        with pytest.raises(RuntimeError, match="no luck"):
            exec(compile(script, "script", "exec"), {})
        assert not [name for name in set(sys.modules) - before if name.startswith("hookean_client_")]


def test_one_changed_letter_gives_another_name(tmp_path):
    """The digest covers every file of the client; the version is read from it."""
    stamps = [
        inline.stamp(client(tmp_path / "a", "1.0.0")),
        inline.stamp(client(tmp_path / "b", "1.0.0")),
        inline.stamp(client(tmp_path / "c", "1.0.0", "# a word\n")),
        inline.stamp(client(tmp_path / "d", "1.0.1")),
    ]
    assert stamps[0] == stamps[1]
    assert len(set(stamps)) == 3
    assert stamps[3].startswith("hookean_client_1_0_1_")


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ("import hookean_client", "import X as hookean_client"),
        ("import hookean_client as c", "import X as c"),
        ("from hookean_client import canvas as c", "from X import canvas as c"),
        ("from hookean_client.canvas import force", "from X.canvas import force"),
        (
            "def f():\n    from hookean_client import (\n        canvas,\n    )",
            "def f():\n    from X import (\n        canvas,\n    )",
        ),
        ("import hookean_clients", "import hookean_clients"),
        ("text = 'import hookean_client'", "text = 'import hookean_client'"),
    ],
)
def test_imports_of_the_client_are_redirected_and_nothing_else(written, told):
    """Every form of import that can be, wherever it stands; texts and longer names stay."""
    assert inline.redirected(written, "X", "code.py") == told


@pytest.mark.parametrize("line", ["import hookean_client.canvas", "import json, hookean_client"])
def test_an_import_that_cannot_be_redirected_is_told(line):
    """The sentence names the line and what to write."""
    with pytest.raises(InputError, match=r"code.py:1: cannot be redirected; write `import hookean_client` alone"):
        inline.redirected(line, "X", "code.py")


def test_a_client_that_cannot_be_inlined_is_told(tmp_path):
    """Modules that need one another, letters Python 2.7 does not read, no version, an unknown flavour."""
    place = client(tmp_path / "circle", "1.0.0")
    (place / "more.py").write_text("from . import counts\n")
    with pytest.raises(InputError, match="modules that import one another"):
        inline.inlined(COUNTING, "rhino7", place)
    place = client(tmp_path / "letters", "1.0.0", "# φ\n")
    with pytest.raises(InputError, match=r"__init__.py: is not ASCII"):
        inline.inlined(COUNTING, "rhino7", place)
    place = client(tmp_path / "nameless", "1.0.0")
    (place / "__init__.py").write_text("")
    with pytest.raises(InputError, match="has no `__version__"):
        inline.inlined(COUNTING, "rhino7", place)
    with pytest.raises(InputError, match="'rhino6' is not one of rhino8, rhino7"):
        inline.inlined(COUNTING, "rhino6")  # type: ignore[arg-type]


def test_a_script_carries_what_it_needs_of_the_client_and_no_more():
    """A force sends text: it needs neither the engine nor COMPAS; the engine needs no sweep."""
    sources = {path.stem: path.read_text() for path in CLIENT.glob("*.py")}
    force = inline.carried("from hookean_client import canvas\ncanvas.force(ghenv, 'unary')", sources)
    assert force[0] == "__init__" and "canvas" in force and "canvas_engine" not in force and "compas" not in force
    engine = inline.carried("from hookean_client import canvas_engine\ncanvas_engine.solve(ghenv, x)", sources)
    assert (
        {*force} - {"canvas"} < set(engine)
        and "canvas_link" not in force
        and "canvas_engine" in engine
        and "canvas_sweep" not in engine
    )


@pytest.mark.parametrize("name", bundles.names())
def test_all_that_a_script_carries_loads_where_it_is_the_first_script(name: str) -> None:
    """Modules travel in blocks: each finds what it imports at the top among those that the script carries."""
    sources = dict(inline._sources(CLIENT))
    code = bundles.read(name).code
    packed = [one for block in inline._blocks(inline.carried(code, sources), sources) for one in block]
    for module in packed:
        assert inline._imported(sources[module], sources, set()) <= set(packed), module


def test_a_definition_stores_once_what_its_scripts_share(tmp_path):
    """A second component of a kind adds less to the compressed file than half of the client that it carries."""
    sizes = []
    for count in (1, 2):
        made = Definition("shared", "Shared", "Settings that carry the same client.")
        with made.group("Settings"):
            for _ in range(count):
                made.component("Settings")
        made.save(tmp_path / "definition.gh")
        sizes.append((tmp_path / "definition.gh").stat().st_size)
    carried = bundles.read("Settings").code
    packed = max(re.findall(r'""" *\n([^ "]{60,})"""', inline.inlined(carried)), key=len)
    assert sizes[1] - sizes[0] < 0.5 * len(packed), sizes


def test_scripts_that_carry_different_parts_share_one_client():
    """Whichever runs first, the other adds what is missing to the same modules."""
    before = set(sys.modules)
    parts = ["from hookean_client import canvas\nfound = canvas", "from hookean_client import canvas, canvas_curves"]
    try:
        for order in (parts, parts[::-1]):
            spaces: list[dict[str, object]] = [{}, {}]
            for code, space in zip(order, spaces, strict=True):
                exec(compile(inline.inlined(code, "rhino7"), "script", "exec"), space)
            assert spaces[0]["canvas"] is spaces[1]["canvas"]
            for name in set(sys.modules) - before:
                del sys.modules[name]
    finally:
        for name in set(sys.modules) - before:
            del sys.modules[name]


def test_comments_and_docstrings_stay_at_home():
    """What runs is the same, statement for statement and line for line."""
    for path in CLIENT.glob("*.py"):
        source = path.read_text()
        told = inline.bare(source)
        assert len(told) < len(source) and told.count("\n") == source.count("\n")
        assert _statements(told) == _statements(source)


def _statements(source: str) -> list[tuple[str, int]]:
    """Kind and line of every statement but texts that stand alone."""
    found = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.stmt)]
    alone = [n for n in found if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant)]
    return sorted((type(node).__name__, node.lineno) for node in found if node not in alone)
