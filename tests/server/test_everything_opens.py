"""Every Rhino file of the shared data opens by the requests of the page, or a choice of the import sheet leads to a
model; points alone are what one draws lines between. That every figure opens is in `test_gallery.py`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from soak import sampled

from .test_recipes import asked

RHINO = Path(__file__).parents[3] / "shared" / "data" / "rhino"
FILES = sorted(path.name for path in RHINO.glob("*.3dm"))
WHOLE = {"rest_factor": 1, "held": "all"}
CHOICES: dict[str, tuple[str, dict[str, Any]]] = {
    "v7_my_brep.3dm": ("brep", WHOLE),
    "v7_my_mesh.3dm": ("mesh", WHOLE),
    "v7_rhino_logo_nurbs.3dm": ("Rhino Logo", WHOLE),
}
"""Closed surfaces start as left out: the layer, and the values of a net of it. All is held, as its reason says."""
SENTENCES = {
    "v7_my_trimmed_surface.3dm": ('layer "trimmed surface"', "without a render mesh", "choose whole"),
}
"""Files whose first proposal is no model, and what the sheet reports of them."""


def works(client: httpx.Client, made: httpx.Response) -> None:
    """A session has particles, takes a frame, and ends."""
    assert made.status_code == 201, made.text
    address = made.headers["location"]
    try:
        assert client.post(f"{address}/step").json()["status"] in ("running", "converged")
        state = client.get(f"{address}/state").json()
        assert len(state["particles"]) == made.json()["particles"] > 1 and np.isfinite(state["particles"]).all()
    finally:
        assert client.delete(address).status_code == 204


@pytest.mark.thinned
@pytest.mark.skipif(not FILES, reason="the files of Rhino are not here")
@pytest.mark.parametrize("name", sampled((name for name in FILES if name not in SENTENCES), 3))
def test_a_rhino_file_leads_to_a_model(client: httpx.Client, name: str) -> None:
    """By the first proposal of the import sheet, or by a role given to a layer that starts as left out for a reason."""
    data = (RHINO / name).read_bytes()
    draft = asked(client, None, data, name).json()
    if name in CHOICES:
        layer, values = CHOICES[name]
        [row] = [row for row in draft["rows"] if row["layer"] == layer]
        assert "give a layer one of these roles" in draft["fault"] and row["role"] == "ignore"
        assert all("hold all of it" in found["why"] for found in row["objects"])
        chosen = {"layer": layer, "family": row["family"], "role": "net", "values": values}
        draft = asked(client, {"rows": [chosen]}, data, name).json()
    assert not draft["fault"] and draft["particles"] > 1
    form = {"file": (name, data), "recipe": (None, json.dumps(draft["recipe"]))}
    works(client, client.post("/v1/sessions", files=form))


@pytest.mark.skipif(not FILES, reason="the files of Rhino are not here")
@pytest.mark.parametrize("name", SENTENCES)
def test_a_file_without_a_model_gets_a_sentence(client: httpx.Client, name: str) -> None:
    """What is missing and what to do; trimmed faces give a model without their cuts where that is chosen."""
    data = (RHINO / name).read_bytes()
    draft = asked(client, None, data, name).json()
    assert all(words in draft["fault"] for words in SENTENCES[name])
    [row] = [row for row in draft["rows"] if row["layer"] == "trimmed surface"]
    chosen = {"layer": row["layer"], "family": row["family"], "role": "net", "values": {"divide_trimmed": "whole"}}
    whole = asked(client, {"rows": [chosen]}, data, name).json()
    assert not whole["fault"] and whole["particles"] > 1
    form = {"file": (name, data), "recipe": (None, json.dumps(whole["recipe"]))}
    works(client, client.post("/v1/sessions", files=form))


@pytest.mark.skipif("v7_my_points.3dm" not in FILES, reason="the file of Rhino is not here")
def test_points_alone_become_held_particles_to_draw_between(client: httpx.Client) -> None:
    """Five points on three layers; a spring that is drawn between two is part of the session. Where all of them are
    loads there is nothing to draw between."""
    name = "v7_my_points.3dm"
    data = (RHINO / name).read_bytes()
    draft = asked(client, None, data, name).json()
    assert (draft["fault"], draft["particles"], draft["held"]) == ("", 5, 5)
    assert "draw lines between them" in draft["notes"][-1]
    form = {"file": (name, data), "recipe": (None, json.dumps(draft["recipe"]))}
    made = client.post("/v1/sessions", files=form)
    assert made.status_code == 201, made.text
    spring = {"kind": "springs", "name": "drawn lines", "particles": [[0, 4]]}
    drawn = client.patch(made.headers["location"], json={"draw": {"add": {"forces": [spring]}}})
    assert drawn.status_code == 200, drawn.text
    works(client, made)
    rows = [{"layer": row["layer"], "family": "points", "role": "loads"} for row in draft["rows"]]
    assert "give a layer the role anchors" in asked(client, {"rows": rows}, data, name).json()["fault"]
