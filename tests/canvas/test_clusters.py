"""Clusters run: what is in them takes their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from canvas.kangaroo_samples import Kangaroo
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Type
from hookean_canvas.definitions.write import Made
from hookean_canvas.run.checking import check


def hook(d: Kangaroo, side: str, nickname: str, source: Made | None = None) -> Made:
    """Cluster Input or Cluster Output: a parameter by its name."""
    made = d.parameter("Data", f"{side} {nickname}", source=source)
    made.container.items = [item for item in made.container.items if item.name not in ("Name", "NickName")]
    made.container.put("Name", Type.STRING, f"Cluster {side}").put("NickName", Type.STRING, nickname)
    return made


def times(factor: int, nested: bytes | None = None) -> bytes:
    """A cluster that multiplies by a factor, after what another one does."""
    d = Kangaroo(f"times {factor}", "Times", "A cluster.")
    given = hook(d, "Input", "In")
    if nested is not None:
        given = d.cluster("Inner", nested, given)
    product = d.native("Multiplication", a=given, b=d.slider("Factor", factor, 0, 10))
    hook(d, "Output", "Out", product)
    return archive.to_bytes(d.archive())


def outer(*documents: bytes) -> Kangaroo:
    d = Kangaroo("outer", "Outer", "Clusters in a row, and the last twice.")
    value: Made = d.parameter("Number", "Numbers", [2.0, 3.0])
    for i, document in enumerate(documents):
        value = d.cluster(f"Cluster {i}", document, value)
    d.panel("product", value)
    other = d.cluster("Again", documents[-1], d.slider("Seven", 7, 0, 10))
    d.panel("again", other)
    return d


def test_clusters_run_within_clusters_and_twice(tmp_path: Path) -> None:
    """(2, 3) x 3, then x 5 x 7 in a cluster within a cluster; 7 x 35 by the same one beside it."""
    path = tmp_path / "clusters.gh"
    archive.write(outer(times(3), times(7, times(5))).archive(), path)
    outcome = check(path).outcome
    assert outcome.panels["product"].values_in_order() == [2 * 105, 3 * 105]
    assert outcome.panels["again"].values_in_order() == [7 * 35]


def test_a_cluster_that_cannot_be_opened_is_named_with_its_reason(tmp_path: Path) -> None:
    path = tmp_path / "closed.gh"
    archive.write(outer(b"with a password").archive(), path)
    with pytest.raises(InputError, match="its document cannot be read; it may have a password"):
        check(path)
    none = Kangaroo("none", "None", "No hooks.")
    none.slider("Nine", 9, 0, 10)
    archive.write(outer(archive.to_bytes(none.archive())).archive(), path)
    with pytest.raises(InputError, match="it has 1 inputs and 1 outputs, and 0 and 0 inside"):
        check(path)


def test_a_cluster_in_itself_without_end_is_refused(tmp_path: Path) -> None:
    """Forty clusters in one another: twenty are opened, the next one is named."""
    document = times(1)
    for _ in range(40):
        document = times(1, document)
    path = tmp_path / "deep.gh"
    archive.write(outer(document).archive(), path)
    with pytest.raises(InputError):
        check(path)
