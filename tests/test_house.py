"""The house: who may import whom, how large files may grow, what the project must carry."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

from mutation import table as mutants

ROOT = Path(__file__).parents[1]
SOURCES = sorted(p for top in ("core", "server", "components", "canvas") for p in (ROOT / top).rglob("*.py"))

PAGE = sorted(p for p in (ROOT / "studio" / "src").rglob("*") if p.suffix in (".ts", ".tsx", ".css"))


def imports(path: Path) -> set[str]:
    """Top-level names of everything a file imports, at any depth."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module.split(".")[0])
    return names


def barred(path: Path) -> set[str]:
    """What a file may not import."""
    top = path.relative_to(ROOT).parts[0]
    if top == "components":
        return {"hookean", "hookean_server", "numpy"}
    if top == "server":
        return {"hookean_client", "hookean_canvas"}
    if top == "core":
        geometry = set() if {"files", "discretize"} & set(path.parts) else {"rhino3dm", "compas"}
        return {"fastapi", "starlette", "uvicorn", "hookean_server", "hookean_client", "hookean_canvas"} | geometry
    return set()


def test_imports_point_one_way():
    """The core knows no HTTP and no server; the server is transport; components know only their client."""
    crossing = {str(path.relative_to(ROOT)): found for path in SOURCES if (found := imports(path) & barred(path))}
    assert not crossing


def test_a_file_is_one_idea():
    """No source file above 20 kB."""
    sizes = {str(path.relative_to(ROOT)): path.stat().st_size for path in SOURCES + PAGE}
    assert len(sizes) > 500
    assert not {path: size for path, size in sizes.items() if size > 20_000}


def test_the_pages_sources_keep_to_the_line():
    """120 characters a line; no type is given up, and no comment turns a check off."""
    given_up = re.compile(r"\bas any\b|: any\b|<any>|@ts-(ignore|nocheck|expect-error)")
    texts = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in PAGE}
    assert len(texts) > 50
    assert not [path for path, text in texts.items() if max(map(len, text.splitlines())) > 120]
    assert not [path for path, text in texts.items() if given_up.search(text)]


def test_the_page_loads_nothing_from_elsewhere():
    """No address outside the service is in its sources."""
    text = "".join(path.read_text(encoding="utf-8") for path in [*PAGE, ROOT / "studio" / "index.html"])
    assert not re.findall(r"https?://(?!www\.w3\.org/)[^\s\"'`]*", text)


def test_solvers_and_forces_import_without_numba():
    """`import hookean`, a scene and the catalogue of forces must not pay for the compiler."""
    import subprocess
    import sys

    code = (
        "import sys, hookean; from hookean import Scene; Scene(particles=[[0, 0, 0]]);"
        "assert not {'numba', 'matplotlib', 'fastapi', 'rhino3dm', 'compas'} & set(sys.modules), sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_the_project_carries_what_it_needs():
    """Licence, changelog, the two commands of the README, and no plain skips or leftovers in the sources."""
    carried = (
        "README.md",
        "CHANGELOG.md",
        "CITATION.cff",
        "CONTRIBUTING.md",
        "LICENSE",
        "Makefile",
        "SECURITY.md",
        ".ci/run",
    )
    for name in carried:
        assert (ROOT / name).stat().st_size > 0
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "make run" in readme
    assert "make test" in readme
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_every_module_among_the_mutants_has_tests():
    """The tests and modules of `make mutants` exist; forces are among them without being listed."""
    core, modules = ROOT / "core" / "hookean", mutants.modules()
    assert {f"forces/{path.name}" for path in (core / "forces").glob("*.py")} <= set(modules)
    for module, chosen in modules.items():
        files = [ROOT / argument for argument in chosen["tests"] if argument.endswith(".py")]
        assert files and all(path.is_file() for path in [core / module, *files]), module
    for survivor in mutants.TABLE["survivors"]:
        assert survivor["place"].split()[0] in modules and len(survivor["reason"]) > 20, survivor
