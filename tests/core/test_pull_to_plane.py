"""Pulls to planes and lines: the closest point is a projection, so that everything is linear."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

PULL, SOFT = 120.0, 7.0


def rest(start: np.ndarray, **force: Any) -> Any:
    """Particles that a soft anchor holds where they start, and a force pulls elsewhere."""
    anchors = {"kind": "anchor_spring", "particles": range(len(start)), "strength": SOFT}
    forces = [{"particles": range(len(start)), "strength": PULL, **force}, anchors]
    return relax(Scene(particles=start, forces=forces, settings={"tolerance": 1e-13}))


@pytest.mark.parametrize("kind", ["pull_to_plane", "pull_to_line"])
def test_a_particle_rests_between_its_anchor_and_its_foot(kind: str) -> None:
    """The energy k |P y|^2 / 2 + S |y - y0|^2 / 2 with P the projection off the plane or line is least where what P
    keeps is S / (k + S) of what it was, and the rest is unchanged; any length of the vector gives the same."""
    rng = np.random.default_rng(1)
    start, origins, ways = rng.normal(size=(3, 5, 3))
    along = ways / np.linalg.norm(ways, axis=1)[:, None]
    keeps = np.einsum("ni,nj->nij", along, along)
    keeps = keeps if kind == "pull_to_plane" else np.eye(3) - keeps
    way = {"normal" if kind == "pull_to_plane" else "direction": ways * 10.0 ** rng.integers(-3, 4, (5, 1))}
    found = rest(start, kind=kind, origin=origins, **way)
    off = np.einsum("nij,nj->ni", keeps, start - origins)
    expected = start - PULL / (PULL + SOFT) * off
    assert found.particles == pytest.approx(expected, abs=1e-11)
    left = SOFT / (PULL + SOFT) * off
    assert found.forces[0]["force"] == pytest.approx(-PULL * left, abs=1e-9)
    assert found.forces[0]["distance"] == pytest.approx(np.linalg.norm(left, axis=1), abs=1e-11)


@pytest.mark.parametrize(("kind", "free"), [("pull_to_plane", [1, 1, 0]), ("pull_to_line", [0, 0, 1])])
def test_the_defaults_are_the_xy_plane_and_the_z_axis(kind: str, free: list[int]) -> None:
    """One pull alone: what it does not resist stays, to the bit, and the rest goes to 0."""
    start = np.array([[3.0, -2.0, 5.0]])
    found = relax(Scene(particles=start, forces=[{"kind": kind, "particles": [0]}], settings={"tolerance": 1e-12}))
    assert np.abs(found.particles - start * free).max() < 1e-9
    assert (found.particles[start * free != 0] == start[start * free != 0]).all()


@pytest.mark.parametrize(("kind", "name"), [("pull_to_plane", "normal"), ("pull_to_line", "direction")])
def test_vectors_of_zero_length_are_refused(kind: str, name: str) -> None:
    """They have no direction: the first of them is named."""
    for given, spot in (([0, 0, 0], ""), ([[1, 0, 0], [0, 0, 0]], "/1")):
        message = f"/forces/0/{name}{spot}: a vector of zero length given; give one that is not 0, 0, 0"
        with pytest.raises(InputError, match=message):
            Scene(particles=np.eye(3)[:2], forces=[{"kind": kind, "particles": [0, 1], name: given}])
