"""Mutation testing: the source is changed at one place at a time, and the tests that concern it have to fail.

`make mutants` runs this. The changes are mutmut's (another operator, another number, an argument left out ...), without
those of wording, and without those that put None where a value is used, which fail anyhow. Of each module in
`table.toml` a fixed number is taken: those with the lowest digests, so that an edit of the source changes only the
sample of what was edited. Changes that no test notices are compared with the list in `table.toml`, which has the reason
why none can; the run fails on others and prints them in the form of that list.

The tests run on a copy of the core with compiled code of its own. What a change does not reach keeps its code.
"""

from __future__ import annotations

import ast
import compileall
import hashlib
import json
import os
import py_compile
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import ndiff
from pathlib import Path
from typing import Any

import libcst as cst
from mutmut.mutation.mutators import mutation_operators, operator_arg_removal, operator_assignment, operator_string
from table import ROOT, TABLE, modules

CORE = ROOT / "core" / "hookean"
MODULES = modules()
KNOWN = {(known["place"], known["before"], known["after"]) for known in TABLE["survivors"]}
OPERATORS = [(kind, made) for kind, made in mutation_operators if made not in (operator_string, operator_assignment)]
SLOWEST = 300.0  # seconds that the tests of one mutant may last, many times what any needs


@dataclass
class Found(cst.CSTVisitor):
    """All mutants of a module: the function, the node and what replaces it."""

    mutants: list[tuple[str, cst.CSTNode, cst.CSTNode]] = field(default_factory=list)
    scopes: list[str] = field(default_factory=list)

    def on_visit(self, node: cst.CSTNode) -> bool:
        if isinstance(node, cst.FunctionDef | cst.ClassDef):
            self.scopes.append(node.name.value)
            if node.name.value == "example":  # any numbers will do there
                return False
        for kind, made in OPERATORS:
            if isinstance(node, kind):
                changed = [one for one in made(node) if made is not operator_arg_removal or _leaves_out(node, one)]
                self.mutants += [(".".join(self.scopes), node, one) for one in changed]
        return not isinstance(node, cst.Annotation | cst.Decorator | cst.SimpleString)

    def on_leave(self, node: cst.CSTNode) -> None:
        if isinstance(node, cst.FunctionDef | cst.ClassDef):
            self.scopes.pop()


def _leaves_out(node: Any, mutated: Any) -> bool:
    """Whether an argument is left out (not None in its place) that is not a description."""
    left_out = [one for one in node.args if not any(one is other for other in mutated.args)]
    return len(mutated.args) < len(node.args) and not any(
        one.keyword is not None and one.keyword.value == "description" for one in left_out
    )


@dataclass
class Mutant:
    """A changed module; `before` and `after` are the lines that differ."""

    module: str
    place: str
    code: str
    before: str
    after: str

    @property
    def known(self) -> bool:
        """Whether `table.toml` has the reason why it survives."""
        return (self.place, self.before, self.after) in KNOWN

    def __str__(self) -> str:
        lines = [f"{name} = {json.dumps(getattr(self, name))}" for name in ("place", "before", "after")]
        return "\n".join(["[[survivors]]", *lines, 'reason = ""', ""])


def mutants(module: str, count: int) -> Iterator[Mutant]:
    """The sample of a module."""
    source = (CORE / module).read_text(encoding="utf-8")
    tree = cst.parse_module(source)
    found = Found()
    tree.visit(found)
    ranked, seen = [], Counter[str]()
    for scope, node, mutated in found.mutants:
        text = "\n".join([module, scope, tree.code_for_node(node), tree.code_for_node(mutated)])
        seen[text] += 1
        digest = hashlib.sha256(f"{text}\n{seen[text]}".encode()).hexdigest()
        ranked.append((digest, scope, node, mutated))
    for _, scope, node, mutated in sorted(ranked, key=lambda one: one[0])[:count]:
        code = tree.deep_replace(node, mutated).code  # type: ignore[union-attr]
        lines = list(ndiff(source.splitlines(), code.splitlines()))
        before, after = ("\n".join(line[2:].strip() for line in lines if line[0] == sign) for sign in "-+")
        yield Mutant(module, f"{module} {scope}", code, before, after)


def reached(module: str) -> set[str]:
    """Names of the modules whose machine code may hold something of a module: those that import it."""
    found: set[str] = set()
    new = {_dotted(CORE / module)}
    inlined = [path for folder in ("films", "forces", "linear", "solvers") for path in (CORE / folder).glob("*.py")]
    while not new <= found:
        found |= new
        new = {_dotted(path) for path in inlined if found & set(_imports(path))}
    return found


def _dotted(path: Path) -> str:
    return ".".join(path.relative_to(CORE.parent).with_suffix("").parts)


def _imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            yield from (str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names))


class Bench:
    """A copy of the core with a cache for its compiled code, in a folder, and the tests of a module run on it."""

    def __init__(self, folder: Path) -> None:
        self.core, self.cache = folder / "core" / "hookean", folder / "cache"
        shutil.copytree(CORE, self.core, ignore=shutil.ignore_patterns("__pycache__"))
        (folder / "gh_examples").symlink_to(ROOT / "gh_examples")
        # files that change within a second are told apart by what they hold
        compileall.compile_dir(self.core, quiet=1, invalidation_mode=py_compile.PycInvalidationMode.CHECKED_HASH)

    def outcome(self, mutant: Mutant) -> str:
        """`survived` where no test fails, else `killed` or `timeout`."""
        path, original = self.core / mutant.module, CORE / mutant.module
        path.write_text(mutant.code, encoding="utf-8")
        try:
            return self.test(mutant.module, reached(mutant.module))
        finally:
            shutil.copy2(original, path)
            shutil.rmtree(self.cache / "reached", ignore_errors=True)

    def test(self, module: str, reached: set[str]) -> str:
        """The tests of a module; modules that are `reached` compile their code once more."""
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "mutation.kept"]
        own = {
            "PYTHONPATH": os.pathsep.join([str(self.core.parent), str(ROOT / "tests")]),
            "PYTHONDONTWRITEBYTECODE": "1",
            "HOOKEAN_CACHE": str(self.cache),
            "HOOKEAN_REACHED": " ".join(sorted(reached)),
        }
        running = subprocess.Popen(
            [*command, *MODULES[module]["tests"]], cwd=ROOT, env={**os.environ, **own},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
        try:
            return "killed" if running.wait(SLOWEST) else "survived"
        except subprocess.TimeoutExpired:
            return "timeout"
        finally:
            if running.poll() is None:
                os.killpg(running.pid, signal.SIGKILL)
                running.wait()


def main(modules: list[str]) -> int:
    """Run the sample of all modules, or of some; returns how many new survivors there are."""
    total, new = Counter[str](), 0
    with tempfile.TemporaryDirectory(prefix="hookean-mutants-") as folder:
        bench = Bench(Path(folder))
        for module in modules or MODULES:
            if bench.test(module, set()) != "survived":
                raise SystemExit(f"{module}: its tests fail without a mutant: {TABLE['modules'][module]['tests']}")
            begun, outcomes = time.monotonic(), Counter[str]()
            for mutant in mutants(module, MODULES[module]["mutants"]):
                outcome = bench.outcome(mutant)
                if outcome == "survived" and mutant.known:
                    outcome = "survived with a reason"
                elif outcome == "survived":
                    print(mutant, flush=True)
                    new += 1
                outcomes[outcome] += 1
            total += outcomes
            print(f"# {module}: {dict(outcomes)} in {time.monotonic() - begun:.0f} s", flush=True)
    print(f"# {total.total()} mutants: {dict(total)}")
    if new:
        print(f"# {new} survived: write a test that fails with each, or put into table.toml the reason why none can")
    return new


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1:])))
