"""Every example: a fresh run gives the numbers of its expected.json, and those come from where they say."""

import json
import os
import subprocess
import sys

import pytest
from matplotlib.image import imread

from hookean.example import Example, examples, gallery, home

ALL = examples()


@pytest.fixture(scope="module")
def oracles() -> dict[str, dict[str, float]]:
    return {}


@pytest.mark.parametrize("example", ALL, ids=lambda e: e.name)
def test_a_fresh_run_gives_the_expected_numbers(example: Example) -> None:
    numbers = example.run().numbers
    assert set(numbers) == set(example.expected.numbers)
    off = {n: float(numbers[n]) for n, e in example.expected.numbers.items() if not e.holds(numbers[n])}
    assert not off, {name: (value, str(example.expected.numbers[name])) for name, value in off.items()}


# a finder in front of all others that knows of no hookean
WITHOUT = """
import sys, runpy
class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("hookean", "hookean_server", "hookean_client"):
            raise ImportError("an oracle imports no hookean")
sys.meta_path.insert(0, Refuse())
runpy.run_path(sys.argv[1], run_name="__main__")
"""


@pytest.mark.parametrize("example", ALL, ids=lambda e: e.name)
def test_numbers_of_scripts_are_what_the_scripts_print_without_hookean(example: Example) -> None:
    sources = {n: e.source.split()[1].rstrip(":") for n, e in example.expected.numbers.items() if e.source[0] == "s"}
    for script in sorted(set(sources.values())):
        run = [sys.executable, "-c", WITHOUT, str(example.folder / script)]
        done = subprocess.run(run, capture_output=True, text=True, timeout=300, env={**os.environ, "PYTHONPATH": ""})
        assert done.returncode == 0, done.stderr
        printed = json.loads(done.stdout)
        for name in (n for n, s in sources.items() if s == script):
            expected = example.expected.numbers[name]
            assert expected.holds(printed[name]), (name, printed[name], str(expected))


@pytest.mark.parametrize("example", ALL, ids=lambda e: e.name)
def test_a_folder_has_all_that_the_gallery_shows(example: Example) -> None:
    inside = {path.name for path in example.folder.iterdir()}
    assert {"example.py", "expected.json", "README.md", "picture.png"} <= inside
    assert "scene.json" in inside or {"model.3dm", "recipe.toml"} <= inside
    pixels = imread(example.folder / "picture.png")[..., :3]
    assert pixels.shape[1] >= 1500
    drawn = (pixels < 0.95).any(axis=2)
    assert 0.01 < drawn.mean() < 0.5, "blank, or filled"
    assert not drawn[[0, -1]].any() and not drawn[:, [0, -1]].any(), "cut off at its edge"


def test_the_gallery_shows_every_example():
    """gh_examples/README.md is what `make figures` would write now."""
    same = (home() / "README.md").read_text(encoding="utf-8") == gallery(ALL)
    assert same, "gh_examples/README.md is not what the examples say: run make figures"
