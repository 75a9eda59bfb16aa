"""Clusters run: what is in them takes their place."""

from __future__ import annotations

from pathlib import Path
from uuid import UUID

import pytest

from canvas.kangaroo_samples import ANCHOR, Kangaroo
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Type
from hookean_canvas.archive.guids import CLUSTER
from hookean_canvas.definitions.write import Made
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.run import graph
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


@pytest.mark.soak
def test_a_cluster_in_itself_without_end_is_refused(tmp_path: Path) -> None:
    """Forty clusters in one another: twenty are opened, the next one is named."""
    document = times(1)
    for _ in range(40):
        document = times(1, document)
    path = tmp_path / "deep.gh"
    archive.write(outer(document).archive(), path)
    with pytest.raises(InputError):
        check(path)


def goals(held: str) -> bytes:
    """A cluster of two goals: springs of its lines, and soft anchors at its points."""
    d = Kangaroo(f"goals {held}", "Goals", "A cluster with goals.")
    lines, ends = hook(d, "Input", "Lines"), hook(d, "Input", "Ends")
    springs = d.kangaroo("Length(Line)", (("Line", None), ("Length", None), ("Strength", 100.0)), ["S"], line=lines)
    held_ = d.kangaroo("Anchor", ANCHOR, ["A"], guid=UUID("3c30b1a1-4473-4ad4-a700-ea9770726c03"), p=ends)
    hook(d, "Output", "Goals", d.parameter("Data", "Both", source=[springs, held_]))
    return archive.to_bytes(d.archive())


def test_a_cluster_of_goals_is_opened_and_its_system_is_translated() -> None:
    """Twice the same cluster, each with its own wires: nothing is left of Kangaroo."""
    d = Kangaroo("roof", "Roof", "Goals in clusters.")
    made = []
    for y in (0, 5):
        ends = [d.point(0, y, 0), d.point(2, y, 0)]
        middle = d.point(1, y, 0)
        lines = [d.native("Line", start_point=end, end_point=middle) for end in ends]
        cluster = d.kangaroo(
            f"Goals {y}", (("Lines", None), ("Ends", None)), ["Goals"], guid=CLUSTER, lines=lines, ends=ends
        )
        cluster.library = None
        cluster.container.put("ClusterDocument", Type.BYTEARRAY, goals("both"))
        made.append(cluster)
    solver = d.solved(*made)
    d.panel("particles", solver["V"])
    after, report = kangaroo.translate(d.archive())
    assert report.complete and report.whole == report.solvers == 1, report.text()
    assert (
        sum("was opened; it is a cluster that holds Length(Line), Anchor of Kangaroo" in note for note in report.notes)
        == 2
    )
    found = graph.of(after)
    assert not found.damage and not any(node.guid == CLUSTER for node in found.nodes)
    springs = [node for node in found.nodes if node.name == "Springs From Line"]
    assert len(springs) == 2
    owners = found.owners()
    for node in springs:
        [source] = node.inputs[0].sources
        hook_, _ = owners[source]
        assert sorted(owners[one][0].name for one in hook_.inputs[0].sources) == ["Line", "Line"]
