"""The docs that come from the classes are what the classes say."""

from __future__ import annotations

import re
from pathlib import Path

from hookean.catalogue import page

ROOT = Path(__file__).parents[1]


def test_the_page_of_forces_is_the_catalogue():
    """docs/forces.md is what `make docs` would write now."""
    same = (ROOT / "docs" / "forces.md").read_text(encoding="utf-8") == page()
    assert same, "docs/forces.md is not what the classes say: run make docs"


def test_the_recipe_and_the_limits_of_the_docs_are_read():
    """The TOML blocks of docs/rhino-files.md parse as a recipe and as limits."""
    from hookean.files.recipe import parse_recipe
    from hookean.files.tables import read_limits

    recipe, limits = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "rhino-files.md").read_text("utf-8"), re.S)
    assert parse_recipe(recipe)["forces"][0]["lines"] == "layer:cables"
    assert read_limits(limits, "limits.toml")
