"""The client on every Python of this machine from 2.7 on, and what it is written in."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import hookean_client
from pythons import interpreter
from serving import CABLE, HANG, Home

SOURCE = Path(hookean_client.__file__)
FILES = [
    SOURCE,
    *(SOURCE.with_name(name) for name in ("client.py", "finding.py", "transport.py", "sessions.py", "websocket.py")),
]
VERSIONS = ["2.7", *(f"3.{minor}" for minor in range(6, 15))]


def interpreters() -> list[str]:
    """The newest of each version that is found, this one among them."""
    found = [interpreter(version) for version in VERSIONS] + [shutil.which("ipy")]
    return [python for python in found if python]


def sample() -> list[Any]:
    """All of them; those between the oldest and the newest are left to `make soak`."""
    found = interpreters()
    return [*found[:1], *(pytest.param(python, marks=pytest.mark.soak) for python in found[1:-1]), *found[1:][-1:]]


SMOKE = """
import json, sys, time
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import hookean_client.transport
hookean_client.transport.ANSWER = 120.0
scene = json.loads(sys.argv[3])
client = hookean_client.connect(start=False, folder=sys.argv[2])
scene["particles"] = hookean_client.buffer(scene["particles"])
assert client.relax(scene, timeout=600.0)["status"] == "converged"
session = client.session("v%d%d" % sys.version_info[:2])
session.put(scene)
frames = session.frames()
assert frames.wait(timeout=120.0) is not None, frames.message
session.play()
revision = session.edit({"forces": {"1": {"vector": [0, 0, -30]}}})["revision"]
frame = frames.wait(lambda frame: frame["revision"] >= revision, timeout=120.0)
assert frame is not None and len(frame["particles"]) == 18, frames.message
session.pause()
assert session.undo()["redo"] == 1
assert b"3D Geometry File Format" in session.state("3dm")[:64]
try:
    session.edit({"forces": {"9": {}}})
except hookean_client.Problem as problem:
    assert problem.status == 422 and problem.errors and "/forces/9" in str(problem)
else:
    raise AssertionError("no problem")
frames.close()
session.delete()
client.close()
print("done")
"""


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    found = Home(tmp_path_factory.mktemp("versions") / "state")
    found.serve()
    yield found
    found.end()


@pytest.mark.parametrize("python", sample())
def test_every_python_speaks_with_the_server(home: Home, python: str) -> None:
    import json

    words = [str(SOURCE.parents[1]), str(home.folder), json.dumps(CABLE)]
    done = subprocess.run([python, "-c", SMOKE, *words], capture_output=True, text=True, timeout=HANG, check=False)
    assert (done.stdout.strip(), done.returncode) == ("done", 0), done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="ends with a signal of POSIX")
@pytest.mark.parametrize("python", interpreters()[:1])
def test_the_oldest_python_starts_a_server(tmp_path: Path, python: str) -> None:
    home = Home(tmp_path / "state")
    code = (
        "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1]); import hookean_client\n"
        "print(hookean_client.connect(folder=sys.argv[2], python=sys.argv[3], timeout=120.0, parent=0).instance)"
    )
    words = [str(SOURCE.parents[1]), str(home.folder), sys.executable]
    try:
        done = subprocess.run([python, "-c", code, *words], capture_output=True, text=True, timeout=HANG, check=False)
        assert done.stdout.strip() == home.told["instance"], done.stderr
    finally:
        home.end()


def test_it_is_written_in_what_all_pythons_read() -> None:
    """Nothing that Python 2.7 has not: also where there is none on this machine."""
    newer = (
        ast.JoinedStr, ast.AnnAssign, ast.AsyncFunctionDef, ast.Await, ast.YieldFrom, ast.Nonlocal, ast.Starred,
        ast.NamedExpr, ast.MatMult, ast.Match,
    )  # fmt: skip
    text = "".join(path.read_text(encoding="ascii") for path in FILES)
    for node in ast.walk(ast.parse(text)):
        assert not isinstance(node, newer) or _star_of_a_call(node, text), ast.dump(node)
        if isinstance(node, ast.FunctionDef | ast.Lambda):
            assert not node.args.kwonlyargs and not node.args.posonlyargs
            assert not any(argument.annotation for argument in node.args.args)
        if isinstance(node, ast.FunctionDef):
            assert node.returns is None
        if isinstance(node, ast.ClassDef):
            assert node.bases and not node.keywords, "a class of Python 2 names its base"
        if isinstance(node, ast.Raise):
            assert node.cause is None
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id != "super" or node.args


def _star_of_a_call(node: ast.AST, text: str) -> bool:
    calls = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call)]
    return isinstance(node, ast.Starred) and any(ast.dump(node) == ast.dump(a) for call in calls for a in call.args)


def test_it_needs_the_standard_library_alone() -> None:
    found = set()
    for node in [node for path in FILES for node in ast.walk(ast.parse(path.read_text()))]:
        if isinstance(node, ast.Import):
            found |= {alias.name.split(".")[0] for alias in node.names}
        if isinstance(node, ast.ImportFrom) and not node.level:
            found.add(str(node.module).split(".")[0])
    assert found - {"httplib"} <= set(sys.stdlib_module_names)


def test_its_version_and_the_servers() -> None:
    import hookean
    from hookean_client import sessions
    from hookean_server.sessions import wire

    assert hookean_client.__version__ == hookean.__version__
    assert hookean_client.WIRE == wire.VERSION
    assert tuple(sessions.STATUSES) == wire.STATUSES
