"""The natives as a list for docs/canvas.md: `python -m hookean_canvas.run.natives.listing` writes it there."""

from __future__ import annotations

import textwrap
from pathlib import Path

from hookean_canvas.run.natives import INERT, INERT_NAMES, NATIVES, PARAMETERS, PLUGINS

START = "<!-- natives, made by hookean_canvas.run.natives.listing -->"
END = "<!-- end of natives -->"
SUBJECTS = {
    "lists": "Lists", "datatrees": "Data trees", "maths": "Maths", "logic": "Comparisons, domains, text",
    "expressions": "Expressions", "vectors": "Points, vectors, planes", "transforms": "Transformations",
    "primitives": "Curves", "curves": "On curves", "meshes": "Meshes", "meshes_made": "Making meshes",
    "subdivision": "Weaverbird, by name", "measures": "Measures and boxes", "surfaces": "Surfaces",
    "curves_at": "Along curves", "surfaces_at": "On surfaces", "sets": "Sets", "tools": "Tools of Kangaroo",
    "chance": "By chance", "edges": "Edges and control points",
    "places": "Places and meetings", "morphs": "Morphs", "meshes_more": "More on meshes and solids",
    "texts": "Texts", "trees_more": "Trees by patterns of paths", "sets_more": "Sets and sequences",
    "maths_more": "Triangles, lists of numbers", "transforms_more": "Mappings, arrays, groups", "bending": "Bending",
    "surfaces_more": "Making surfaces and boxes", "solids": "Solids",
    "fitted": "Fitting", "weaverbird": "Weaverbird and MeshEdit, by name",
    "meshes_edited": "Changing meshes",
    "points_more": "Neighbours and coordinates", "planes": "Planes that are turned", "meetings": "Intersections",
    "curves_more": "Measures of curves", "curves_changed": "Changing curves",
    "grids": "Grids of cells", "regions": "Regions and cells", "sections": "Sections and spans",
    "freeform": "Beside and along curves", "plankton": "Halfedge meshes of Plankton",
}  # fmt: skip
"""Headings by the modules that declare natives."""


def listing() -> str:
    """A line for each subject with the names of its natives, in Markdown."""
    natives = [*NATIVES.values(), *PLUGINS.values()]
    rows = {
        heading: list(dict.fromkeys(native.name for native in natives if native.subject == subject))
        for subject, heading in SUBJECTS.items()
    }
    rows["Parameters"] = [name for name, _ in PARAMETERS.values()]
    rows["Without effect"] = list(dict.fromkeys([*INERT.values(), *sorted(INERT_NAMES)]))
    differ = sorted({f"{native.name}: {native.remark}" for native in natives if native.remark})
    lines = [_wrapped(f"- **{heading}**: {', '.join(names)}.") for heading, names in rows.items()]
    return "\n".join([*lines, "", "What differs from Grasshopper:", "", *(_wrapped(f"- {line}.") for line in differ)])


def _wrapped(text: str) -> str:
    return textwrap.fill(text, 120, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def write(page: Path) -> None:
    """Put the list into a page, between its two marks."""
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(START)
    page.write_text(f"{before}{START}\n{listing()}\n{END}{rest.split(END)[1]}", encoding="utf-8")


if __name__ == "__main__":
    write(Path(__file__).parents[4] / "docs" / "canvas.md")
