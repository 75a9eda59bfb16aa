"""Stand-ins for Grasshopper's own components and parameters, so that definitions run without it.

Each does what its tooltip in Grasshopper and the component index (https://grasshopperdocs.com) describe. A new one is
one function in the module of its subject, with its declaration (`declare`). Ids: `guids`, and public definitions.
"""

from __future__ import annotations

from hookean_canvas.run.natives import (  # noqa: F401  each declares the natives of a subject
    bending,
    chance,
    curves,
    curves_at,
    curves_changed,
    curves_more,
    datatrees,
    edges,
    expressions,
    fitted,
    freeform,
    grids,
    lists,
    logic,
    maths,
    maths_more,
    measures,
    meetings,
    meshes,
    meshes_edited,
    meshes_made,
    meshes_more,
    morphs,
    places,
    planes,
    plankton,
    points_more,
    primitives,
    regions,
    sections,
    sets,
    sets_more,
    solids,
    subdivision,
    surfaces,
    surfaces_at,
    surfaces_more,
    texts,
    tools,
    transforms,
    transforms_more,
    trees_more,
    vectors,
    weaverbird,
)
from hookean_canvas.run.natives.declare import BY_NAME, NATIVES, PLUGINS, Input, Native, Output, Unfit, native_of
from hookean_canvas.run.natives.display import INERT, INERT_NAMES, is_inert
from hookean_canvas.run.natives.kinds import PARAMETERS, as_kind

__all__ = [
    "BY_NAME",
    "INERT",
    "INERT_NAMES",
    "NATIVES",
    "PARAMETERS",
    "PLUGINS",
    "Input",
    "Native",
    "Output",
    "Unfit",
    "as_kind",
    "is_inert",
    "native_of",
]
