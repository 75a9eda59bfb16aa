"""Sessions over HTTP and WebSocket: what a designer, a canvas or another program does with them."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from websockets.sync.client import ClientConnection, connect

from hookean import Scene, Simulation, relax
from hookean.discretize import grid
from hookean_server.sessions.wire import SIZE, Shown, changed, decode
from serving import CABLE, HANG, wait_for

from .conftest import Served, problem


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    server = Served()
    yield server.ready()
    server.end()


@pytest.fixture
def client(served: Served) -> Iterator[httpx.Client]:
    yield served.client
    for session in served.client.get("/v1/sessions").json()["sessions"]:
        served.client.delete(f"/v1/sessions/{session['key']}")


def put(client: httpx.Client, key: str = "a", scene: dict[str, Any] = CABLE) -> dict[str, Any]:
    answer = client.put(f"/v1/sessions/{key}", json=scene)
    assert answer.status_code in (200, 201), answer.text
    found: dict[str, Any] = answer.json()
    return found


def watch(served: Served, key: str = "a", how: str = "") -> ClientConnection:
    headers = {k: v for k, v in served.client.headers.items() if k.lower() == "authorization"}
    return connect(f"{served.url.replace('http', 'ws')}/v1/sessions/{key}/frames{how}", additional_headers=headers)


def frame(socket: ClientConnection, fits: Any = lambda f: True) -> Shown:
    """The next frame that fits; every one is acknowledged."""
    while True:
        message = socket.recv(timeout=HANG)
        if isinstance(message, bytes):
            found = decode(message)
            socket.send(json.dumps({"ack": found.number}))
            if fits(found):
                return found


def test_put_makes_a_session_once_and_the_same_scene_changes_nothing(client: httpx.Client) -> None:
    first = client.put("/v1/sessions/doc:canvas-1", json=CABLE)
    assert first.status_code == 201 and first.headers["location"] == "/v1/sessions/doc:canvas-1"
    again = client.put("/v1/sessions/doc:canvas-1", json=CABLE)
    assert again.status_code == 200 and again.json()["revision"] == first.json()["revision"] == 0
    assert [s["key"] for s in client.get("/v1/sessions").json()["sessions"]] == ["doc:canvas-1"]


def test_post_makes_a_session_under_a_random_key(client: httpx.Client) -> None:
    one, other = (client.post("/v1/sessions", json=CABLE, params={"label": "roof"}) for _ in range(2))
    assert one.status_code == 201 and one.json()["key"] != other.json()["key"]
    assert len(one.json()["key"]) == 32 and one.json()["label"] == "roof"


def test_steps_are_those_of_a_simulation(client: httpx.Client) -> None:
    """Ten frames over HTTP are ten frames of the core, bit for bit."""
    put(client)
    client.post("/v1/sessions/a/step", params={"frames": 10})
    running = Simulation(Scene.read(CABLE))
    running.step(10)
    state = client.get("/v1/sessions/a/state").json()
    assert np.array_equal(state["particles"], running.state.x)
    assert state["iterations"] == 200


def test_playing_ends_at_the_equilibrium_that_python_gives(client: httpx.Client) -> None:
    put(client)
    client.post("/v1/sessions/a/play", params={"fast": True})
    wait_for(lambda: client.get("/v1/sessions/a").json()["status"] == "converged")
    wanted = relax(Scene.read(CABLE)).particles
    assert np.allclose(client.get("/v1/sessions/a/state").json()["particles"], wanted, atol=1e-4)
    assert not client.get("/v1/sessions/a").json()["playing"]


def test_edits_carry_a_revision_and_can_be_taken_back(client: httpx.Client) -> None:
    put(client)
    answer = client.patch("/v1/sessions/a", json={"forces": {"1": {"vector": [0, 0, -5]}}})
    assert answer.json()["revision"] == 1 and answer.headers["etag"] == answer.json()["etag"]
    assert client.get("/v1/sessions/a/scene").json()["forces"][1]["vector"] == [0, 0, -5]
    assert client.post("/v1/sessions/a/undo").json()["revision"] == 2
    assert client.get("/v1/sessions/a/scene").json()["forces"][1]["vector"] == [0, 0, -20]
    assert client.post("/v1/sessions/a/redo").json()["revision"] == 3
    assert client.get("/v1/sessions/a/scene").json()["forces"][1]["vector"] == [0, 0, -5]
    answer = client.post("/v1/sessions/a/redo")
    assert answer.status_code == 422 and "no edit" in answer.json()["detail"]


def test_two_editors_cannot_overwrite_each_other_unseen(client: httpx.Client) -> None:
    seen = {"if-match": put(client)["etag"]}
    first = client.patch("/v1/sessions/a", json={"release": [0]}, headers=seen)
    assert first.status_code == 200
    second = client.patch("/v1/sessions/a", json={"release": [5]}, headers=seen)
    assert second.status_code == 412 and second.json()["type"] == "/problems/stale-revision"
    assert client.get("/v1/sessions/a").json()["revision"] == 1


@pytest.mark.parametrize("given", ['"0"', '"1"', 'W/"1"', '"soon"', '"1", "2"', "", "-1"])
def test_a_refused_edit_has_the_etag_to_try_again_with(client: httpx.Client, given: str) -> None:
    """RFC 9110, section 13.1.1: 412 where If-Match does not match; its ETag is that of the session as it is."""
    put(client)
    client.patch("/v1/sessions/a", json={"release": [0]})
    refused = client.patch("/v1/sessions/a", json={"release": [5]}, headers={"if-match": given})
    assert refused.status_code == 412 and refused.json()["type"] == "/problems/stale-revision"
    assert refused.headers["etag"] == client.get("/v1/sessions/a").headers["etag"]
    again = client.patch("/v1/sessions/a", json={"release": [5]}, headers={"if-match": refused.headers["etag"]})
    assert again.status_code == 200 and again.json()["revision"] == 2


def test_the_etag_of_refusals_is_described(client: httpx.Client) -> None:
    paths = client.get("/v1/openapi.json").json()["paths"]
    refusals = [op["responses"]["412"] for path in paths.values() for op in path.values() if "412" in op["responses"]]
    assert refusals and all("etag" in refusal["headers"] for refusal in refusals)


@pytest.mark.parametrize(
    ("edit", "pointer"),
    [
        ({"pin": [{"particles": [99]}]}, "/pin"),
        ({"forces": {"9": {"vector": [0, 0, 1]}}}, "/forces/9"),
        ({"forces": {"1": {"vector": "down"}}}, "/forces/1/vector"),
        ({"move": [{"anchor": "nobody", "targets": []}]}, "/move/0"),
        ({"undo": True, "release": [0]}, "/undo"),
        ({"geometry": []}, "/geometry"),
        ([], "/"),
    ],
)
def test_a_faulty_edit_changes_nothing(client: httpx.Client, edit: Any, pointer: str) -> None:
    put(client)
    answer = client.patch("/v1/sessions/a", json=edit)
    assert answer.status_code == 422, answer.text
    assert answer.json()["errors"][0]["pointer"].startswith(pointer)
    assert client.get("/v1/sessions/a").json()["revision"] == 0


def test_reset_goes_back_to_the_start_and_keeps_the_supports(client: httpx.Client) -> None:
    """The chapter's trap: anchors that were moved still hold their particles after a reset."""
    put(client)
    client.patch("/v1/sessions/a", json={"move": [{"anchor": 0, "targets": [[0, 0, 3], [10, 0, 0]]}]})
    client.post("/v1/sessions/a/step", params={"frames": 5})
    answer = client.post("/v1/sessions/a/reset").json()
    assert answer["iteration"] == 0 and answer["revision"] == 2
    state = np.array(client.get("/v1/sessions/a/state").json()["particles"])
    assert np.array_equal(state[1:5, 2], np.zeros(4)) and np.array_equal(state[0], [0, 0, 3])
    (anchor,) = client.get("/v1/sessions/a/anchors").json()["anchors"]
    assert anchor["particles"] == [0, 5]


def test_a_new_scene_keeps_particles_that_kept_their_identity(client: httpx.Client) -> None:
    put(client)
    client.post("/v1/sessions/a/step", params={"frames": 5})
    before = np.array(client.get("/v1/sessions/a/state").json()["particles"])
    stiffer = json.loads(json.dumps(CABLE))
    stiffer["forces"][0]["stiffness"] = 2000
    assert put(client, scene=stiffer)["revision"] == 1
    assert np.array_equal(client.get("/v1/sessions/a/state").json()["particles"], before)


def test_a_branch_goes_its_own_way(client: httpx.Client) -> None:
    put(client)
    client.post("/v1/sessions/a/step", params={"frames": 3})
    answer = client.post("/v1/sessions/a/branches", params={"to": "b"})
    assert answer.status_code == 201 and answer.json()["key"] == "b"
    for key in "ab":
        client.post(f"/v1/sessions/{key}/step", params={"frames": 2})
    one, other = (client.get(f"/v1/sessions/{key}/state").json()["particles"] for key in "ab")
    assert one == other
    client.patch("/v1/sessions/b", json={"release": [5]})
    client.post("/v1/sessions/b/step")
    assert client.get("/v1/sessions/a").json()["revision"] == 0
    assert client.post("/v1/sessions/a/branches", params={"to": "b"}).status_code == 409


def test_every_format_is_read_back(client: httpx.Client, tmp_path: Any) -> None:
    """JSON, npz, .3dm, OBJ and COMPAS JSON hold the same particles."""
    import compas
    import rhino3dm

    put(client)
    client.post("/v1/sessions/a/step", params={"frames": 4})

    def get(form: str) -> bytes:
        answer = client.get("/v1/sessions/a/state", params={"format": form})
        assert answer.status_code == 200, answer.text
        return answer.content

    wanted = np.array(json.loads(get("json"))["particles"])
    again = Simulation.load(io.BytesIO(get("npz")))
    assert np.array_equal(again.state.x, wanted)
    vertices = [line.split()[1:] for line in get("obj").decode().splitlines() if line.startswith("v ")]
    assert np.array_equal(np.array(vertices, float), wanted)
    graph = compas.json_loads(get("compas").decode())
    assert np.allclose([graph.node_coordinates(n) for n in graph.nodes()], wanted, atol=0)
    path = tmp_path / "session.3dm"
    path.write_bytes(get("3dm"))
    curves = [o.Geometry for o in rhino3dm.File3dm.Read(str(path)).Objects if "hookean" in _layer(path, o)]
    ends = {
        tuple(np.round([p.X, p.Y, p.Z], 9)) for c in curves if hasattr(c, "PointAtStart") for p in (c.PointAtStart,)
    }
    assert {tuple(np.round(x, 9)) for x in wanted[:-1]} <= ends


def test_a_table_of_forces_has_its_units(client: httpx.Client) -> None:
    """A row for each spring, load and reaction, as `hookean relax --csv` writes it: the springs carry what the result
    says, and reactions and loads are in balance at rest."""
    put(client, scene={**CABLE, "settings": {"tolerance": 1e-9}})
    client.post("/v1/sessions/a/play", params={"fast": True})
    wait_for(lambda: client.get("/v1/sessions/a").json()["status"] == "converged")
    answer = client.get("/v1/sessions/a/state", params={"format": "csv"})
    assert answer.headers["content-type"] == "text/csv; charset=utf-8"
    rows = list(csv.DictReader(io.StringIO(answer.text)))
    assert {"kind", "element", "x [m]", "force [N]", "force z [N]", "strain [-]", "length [m]"} <= set(rows[0])
    result = client.get("/v1/sessions/a/state").json()
    springs = [float(row["force [N]"]) for row in rows if row["kind"] == "springs"]
    assert springs == pytest.approx(result["forces"][0]["force"], rel=1e-12)
    pairs = [[int(p) for p in row["particles"].split()] for row in rows if row["kind"] == "springs"]
    assert pairs == result["forces"][0]["particles"]
    upwards = [float(row["force z [N]"]) for row in rows if row["kind"] in ("reaction", "unary")]
    assert len(upwards) == 8 and abs(sum(upwards)) < 1e-5


@pytest.mark.parametrize(
    ("label", "named"),
    [
        ("", 'attachment; filename="a.{}"'),
        ("roof over yard", 'attachment; filename="roof over yard.{}"'),
        ("../../etc/passwd", 'attachment; filename="etc passwd.{}"'),
        ("Süd", "attachment; filename=\"S_d.{}\"; filename*=UTF-8''S%C3%BCd.{}"),
        ('a"; x="b', "attachment; filename=\"a _ x_ b.{}\"; filename*=UTF-8''a%20%3B%20x%3D%20b.{}"),
        ("\r\n", 'attachment; filename="session.{}"'),
    ],
)
def test_downloads_are_named_as_their_session(client: httpx.Client, label: str, named: str) -> None:
    """RFC 6266; no path, no second header, whatever the label."""
    assert client.put("/v1/sessions/a", json=CABLE, params={"label": label}).status_code == 201
    for form in ("3dm", "obj", "csv", "npz", "compas"):
        answer = client.get("/v1/sessions/a/state", params={"format": form})
        ending = "json" if form == "compas" else form
        assert answer.headers["content-disposition"] == named.replace("{}", ending)
    assert "content-disposition" not in client.get("/v1/sessions/a/state").headers


def test_a_summary_says_what_a_person_should_know(client: httpx.Client) -> None:
    """Energy and units, and in sentences what met no particle, what a step of time would do, what lay beside another:
    at once, after an edit that changes it, and from the start of the next server on, for those in the store."""
    found = put(client, scene={**CABLE, "units": {"force": "kN"}, "settings": {"time_step": 0.01}})
    assert found["units"] == {"length": "m", "force": "kN", "time": "s"} and found["warnings"] == []
    result = client.get("/v1/sessions/a/state").json()
    assert found["energy"] == pytest.approx(result["energy"]["total"])
    client.post("/v1/sessions/a/step", params={"frames": 3})
    moving, result = client.get("/v1/sessions/a").json(), client.get("/v1/sessions/a/state").json()
    assert moving["energy"] == pytest.approx(result["energy"]["total"]) and result["energy"]["kinetic"] > 0
    stiff = client.patch("/v1/sessions/a", json={"forces": {"0": {"stiffness": 1e9}}}).json()
    assert len(stiff["warnings"]) == 1 and "too large" in stiff["warnings"][0]
    assert client.patch("/v1/sessions/a", json={"forces": {"0": {"stiffness": 1000}}}).json()["warnings"] == []
    astray = {**CABLE, "strict": False, "anchors": [{"particles": [0, 5]}, {"name": "post", "points": [[3, 0, 7]]}]}
    assert ["post: its point met no particle" in said for said in put(client, scene=astray)["warnings"]] == [True]
    refused = client.put("/v1/sessions/b", json={**astray, "strict": True})
    assert problem(refused, 422, "invalid-scene")["errors"][0]["pointer"] == "/anchors/1/points"
    lines = [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0.0005], [2, 0, 0]]]
    near = put(client, scene={"forces": [{"kind": "springs", "lines": lines}]})["warnings"]
    assert near == ["1 coordinate was moved onto a particle nearby, within weld_tolerance"]


def test_an_energy_that_is_not_known_is_none(client: httpx.Client) -> None:
    """Pressure follows the surface: it has no potential."""
    faces = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}
    forces = [{"kind": "springs", "mesh": "m"}, {"kind": "pressure", "mesh": "m", "pressure": 1.0}]
    assert put(client, scene={"meshes": {"m": faces}, "forces": forces})["energy"] is None


def test_watchers_hear_of_warnings_and_of_edits_by_others(served: Served, client: httpx.Client) -> None:
    """A revision that is not one's own says that the anchors may be others now."""
    put(client, scene={**CABLE, "settings": {"time_step": 0.01}})
    with watch(served) as socket:
        assert json.loads(socket.recv())["session"]["revision"] == 0

        def told(fits: Any) -> dict[str, Any]:
            while True:
                message = socket.recv(timeout=HANG)
                if isinstance(message, bytes):
                    socket.send(json.dumps({"ack": decode(message).number}))
                elif fits(found := json.loads(message).get("state") or {}):
                    return dict(found)

        for number in (1, 2):
            edit = {"move": [{"anchor": 0, "targets": [[0, 0, number], [10, 0, 0]]}], "gesture": "drag"}
            assert client.patch("/v1/sessions/a", json=edit).json()["revision"] == number
            assert told(lambda s, number=number: s.get("revision") == number)["undo"] == 1
        client.patch("/v1/sessions/a", json={"forces": {"0": {"stiffness": 1e9}}})
        assert "too large" in told(lambda s: s.get("warnings"))["warnings"][0]
        client.post("/v1/sessions/a/undo")
        assert told(lambda s: s.get("warnings") == [])["revision"] == 4


def test_a_hand_pulls_a_particle_and_drags_one_of_an_anchor(client: httpx.Client) -> None:
    """A pull is one edit and leaves the particle free; a dragged end stays with its anchor, alone, in branches too."""
    put(client)

    def anchors() -> list[tuple[int, list[int], list[list[float]]]]:
        found = client.get("/v1/sessions/a/anchors").json()["anchors"]
        return [(a["number"], a["particles"], a["targets"]) for a in found]

    first = anchors()
    for step in range(1, 40):
        pin = {"particles": [2], "targets": [[4, 0.01 * step, 0]]}
        edited = client.patch("/v1/sessions/a", json={"pin": [pin], "gesture": "pull"}).json()
        assert edited["undo"] == 1 and edited["revision"] == step
    assert anchors() == [*first, (-1, [2], [[4, 0.39, 0]])]
    assert client.patch("/v1/sessions/a", json={"release": [2], "gesture": "pull"}).json()["undo"] == 1
    assert anchors() == first
    for step in range(1, 40):
        pin = {"particles": [5], "targets": [[10, 0, 0.01 * step]]}
        edited = client.patch("/v1/sessions/a", json={"pin": [pin], "gesture": "drag"}).json()
    dragged = [(0, [0, 5], [[0, 0, 0], [10, 0, 0.39]])]
    assert edited["undo"] == 2 and anchors() == dragged
    client.post("/v1/sessions/a/step")
    before = client.get("/v1/sessions/a/state").json()["particles"]
    assert before[5] == [10, 0, 0.39]
    branch = client.post("/v1/sessions/a/branches", params={"to": "b"})
    assert branch.status_code == 201
    assert client.get("/v1/sessions/b/anchors").json()["anchors"][0]["targets"] == dragged[0][2]
    client.post("/v1/sessions/a/undo")
    assert anchors() == first
    assert client.post("/v1/sessions/a/redo").json()["undo"] == 2 and anchors() == dragged
    assert client.patch("/v1/sessions/a", json={"release": [5]}).status_code == 200
    assert [particles for _, particles, _ in anchors()] == [[0]]


def _layer(path: Any, item: Any) -> str:
    import rhino3dm

    model = rhino3dm.File3dm.Read(str(path))
    return str(model.Layers[item.Attributes.LayerIndex].FullPath)


def test_topology_has_an_etag_that_edits_keep_and_scenes_change(client: httpx.Client) -> None:
    put(client)
    first = client.get("/v1/sessions/a/topology")
    assert first.json()["springs"] == [[i, i + 1] for i in range(5)] and first.json()["units"]["force"] == "N"
    tag = first.headers["etag"]
    client.patch("/v1/sessions/a", json={"release": [5]})
    assert client.get("/v1/sessions/a/topology", headers={"if-none-match": tag}).status_code == 304
    longer = {**CABLE, "particles": [*CABLE["particles"], [12, 0, 0]]}
    put(client, scene=longer)
    assert client.get("/v1/sessions/a/topology", headers={"if-none-match": tag}).status_code == 200


def test_played_fast_it_comes_to_rest_at_the_same_iteration_every_time(client: httpx.Client) -> None:
    """As quickly as it can, whatever else the machine does: the same iterations, the same bits."""
    ends = []
    for key in "ab":
        put(client, key)
        client.post(f"/v1/sessions/{key}/play", params={"fast": True})
        wait_for(lambda key=key: not client.get(f"/v1/sessions/{key}").json()["playing"])
        told = client.get(f"/v1/sessions/{key}").json()
        assert told["status"] == "converged"
        ends.append((told["iteration"], told["residual"], client.get(f"/v1/sessions/{key}/state").json()["particles"]))
    assert ends[0] == ends[1]


def test_an_edit_over_the_socket_is_in_the_frames_that_follow(served: Served, client: httpx.Client) -> None:
    put(client)
    with watch(served) as socket:
        assert json.loads(socket.recv())["hello"] == 1
        socket.send(json.dumps({"id": 1, "do": "play"}))
        first = frame(socket, lambda f: f.playing)
        assert first.scalars.shape == (5,) and first.reactions.shape == (2, 3)
        edit = {"move": [{"anchor": 0, "targets": [[0, 0, 2], [10, 0, 0]]}], "gesture": "drag"}
        socket.send(json.dumps({"id": 2, "edit": edit}))
        seen = frame(socket, lambda f: f.revision == 1)
        assert seen.particles[0].tolist() == [0, 0, 2]


def test_who_asks_for_changes_gets_them_and_sees_what_others_see(served: Served, client: httpx.Client) -> None:
    """A drag of one corner of a net at rest: each move changes 3 + 2 + 3 numbers or fewer, of 8 bytes each."""
    net = grid(np.arange(20.0), np.arange(20.0))
    rows = {"vertices": net.vertices.tolist(), "faces": net.faces.tolist()}
    springs = {"kind": "springs", "mesh": "net", "stiffness": 100}
    put(client, "net", {"meshes": {"net": rows}, "forces": [springs], "anchors": [{"points": [[0, 0, 0]]}]})
    with watch(served, "net") as plain, watch(served, "net", "?changes=true") as lean:
        seen = []
        for socket in (plain, lean):
            received = socket.recv(timeout=HANG)
            while not isinstance(received, bytes):
                received = socket.recv(timeout=HANG)
            seen.append(received)
            socket.send(json.dumps({"ack": decode(received).number}))
        assert seen[0] == seen[1]
        for step in range(1, 6):
            pin = {"particles": [0], "targets": [[0, 0, 0.1 * step]]}
            client.patch("/v1/sessions/net", json={"pin": [pin], "gesture": "drag"})
            whole = next(m for m in iter(plain.recv, None) if isinstance(m, bytes))
            by = next(m for m in iter(lean.recv, None) if isinstance(m, bytes))
            for socket in (plain, lean):
                socket.send(json.dumps({"ack": decode(whole).number}))
            assert len(by) <= SIZE + 8 * 8 < len(whole) / 50
            seen[1] = changed(seen[1], by)
            assert seen[1] == whole
            assert decode(whole).particles[0].tolist() == pytest.approx([0, 0, 0.1 * step], rel=1e-7)


def test_a_summary_tells_which_edit_changed_the_scene_and_which_the_anchors(client: httpx.Client) -> None:
    """A drag changes the anchors alone, a load the rest of the scene, and taking it back does so again."""

    def now() -> tuple[int, int, int]:
        told = client.get("/v1/sessions/a").json()
        return told["revision"], told["scene_revision"], told["anchors_revision"]

    put(client)
    assert now() == (0, 0, 0)
    client.patch("/v1/sessions/a", json={"pin": [{"particles": [0], "targets": [[0, 0, 1]]}]})
    assert now() == (1, 0, 1)
    client.patch("/v1/sessions/a", json={"forces": {"1": {"vector": [0, 0, -30]}}})
    assert now() == (2, 2, 1)
    client.patch("/v1/sessions/a", json={"settings": {"drag": 0.5}})
    assert now() == (3, 3, 1)
    for revision in (4, 5):
        client.post("/v1/sessions/a/undo")
        assert now() == (revision, revision, 1)
    client.post("/v1/sessions/a/undo")
    assert now() == (6, 5, 6)
    client.patch("/v1/sessions/a", json={"release": [0]})
    assert now() == (7, 5, 7)


def test_a_slow_client_gets_two_frames_and_holds_nobody_up(served: Served, client: httpx.Client) -> None:
    """Two frames are on their way to a client that acknowledges none; another one goes on seeing new ones."""
    swinging = json.loads(json.dumps(CABLE))
    swinging["settings"] = {"drag": 0}
    swinging["forces"][0]["damping"] = 0
    put(client, scene=swinging)
    client.post("/v1/sessions/a/play")
    with watch(served) as slow, watch(served) as quick:
        for _ in range(30):
            frame(quick)
        for _ in range(2):
            while not isinstance(slow.recv(timeout=HANG), bytes):
                pass
        for _ in range(30):
            newest = frame(quick)
        with pytest.raises(TimeoutError):
            while not isinstance(slow.recv(timeout=0.2), bytes):
                pass
        slow.send(json.dumps({"ack": 2**31}))
        assert frame(slow).iteration >= newest.iteration - 400


@pytest.mark.parametrize(
    "message", ["nonsense", "[]", '{"ack": "x"}', '{"do": "fly", "id": 3}', '{"edit": 7, "id": 3}']
)
def test_a_message_that_is_none_is_told_so(served: Served, client: httpx.Client, message: str) -> None:
    from websockets.exceptions import ConnectionClosed

    put(client)
    with watch(served) as socket:
        socket.send(message)
        try:
            while True:
                said = socket.recv(timeout=HANG)
                if isinstance(said, str) and json.loads(said).get("id") == 3:
                    assert json.loads(said)["problem"]["status"] == 422
                    break
        except ConnectionClosed as closed:
            assert closed.rcvd is not None and closed.rcvd.code == 1003
    assert client.get("/v1/sessions/a").status_code == 200


def test_a_session_that_diverges_says_so_and_takes_the_next_edit(client: httpx.Client) -> None:
    explosive = json.loads(json.dumps(CABLE))
    explosive["forces"][0].update(stiffness=1e9, damping=0)
    explosive["settings"] = {"time_step": 0.01}
    put(client, scene=explosive)
    client.post("/v1/sessions/a/play", params={"fast": True})
    wait_for(lambda: client.get("/v1/sessions/a").json()["status"] == "diverged")
    said = client.get("/v1/sessions/a").json()
    assert "Diverged" in said["message"] and not said["playing"]
    assert np.isfinite(np.array(client.get("/v1/sessions/a/state").json()["particles"])).all()
    client.patch("/v1/sessions/a", json={"forces": {"0": {"stiffness": 1000}}})
    client.post("/v1/sessions/a/step")
    assert client.get("/v1/sessions/a").json()["status"] == "running"


def test_a_deleted_session_is_gone_for_its_watchers_too(served: Served, client: httpx.Client) -> None:
    from websockets.exceptions import ConnectionClosed

    put(client)
    with watch(served) as socket:
        client.delete("/v1/sessions/a")
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                socket.recv(timeout=HANG)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 4404
    assert client.get("/v1/sessions/a").status_code == 404
    assert client.delete("/v1/sessions/a").status_code == 404


def test_there_is_a_most_of_sessions_and_the_next_is_told_when_to_come_back() -> None:
    server = Served(sessions=2, awake=1)
    try:
        server.ready()
        put(server.client, "a"), put(server.client, "b")
        answer = server.client.put("/v1/sessions/c", json=CABLE)
        assert answer.status_code == 429 and int(answer.headers["retry-after"]) > 0
        # one process for two sessions: each wakes the other's place
        for key in "abab":
            assert server.client.post(f"/v1/sessions/{key}/step").status_code == 200
        assert server.client.get("/v1/sessions/a/state").json()["iterations"] == 40
    finally:
        server.end()
