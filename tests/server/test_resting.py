"""To rest: a session relaxes with the scene's own solver, to the bit as `hookean.relax`, and may be stopped on the way.

Oracle: the Python API in this process.
"""

from __future__ import annotations

import asyncio
from typing import Any

import httpx
import numpy as np
import pytest

from hookean import Scene, Simulation, relax
from hookean_server.sessions.process import SessionProcess
from hookean_server.store import Store
from serving import CABLE, SWING, wait_for
from soak import sampled

from .test_manager import opened

JSON = {"content-type": "application/json"}
SIDE = 66


def net(side: int) -> dict[str, Any]:
    """A net of springs with held edges under its weight; from 4,000 particles on `auto` solves it by multigrid."""
    at = np.arange(side * side).reshape(side, side)
    pairs = np.concatenate(
        [np.stack([a.ravel(), b.ravel()], 1) for a, b in ((at[1:], at[:-1]), (at[:, 1:], at[:, :-1]))]
    )
    edge = np.unique(np.concatenate([at[0], at[-1], at[:, 0], at[:, -1]]))
    x, y = np.divmod(np.arange(side * side), side)
    return {
        "particles": np.stack([x, y, 0 * x], 1).tolist(),
        "forces": [
            {"kind": "springs", "particles": pairs.tolist(), "stiffness": 1000, "rest_factor": 0.9},
            {"kind": "self_weight", "total": 10.0 * side},
        ],
        "anchors": [{"particles": edge.tolist()}],
    }


SCENES: dict[str, dict[str, Any]] = {
    "cable": CABLE,
    "net": net(SIDE),
    "physical": {**CABLE, "settings": {"solver": "verlet", "tolerance": 1e-4}},
    "unfinished": {**net(8), "settings": {"solver": "relaxation", "max_iterations": 30}},
}


def rested(client: httpx.Client, address: str) -> dict[str, Any]:
    """How a session is after it has gone to rest."""
    assert client.post(f"{address}/relax").status_code == 200
    wait_for(lambda: not client.get(address).json()["playing"])
    found: dict[str, Any] = client.get(f"{address}/state").json()
    return found


@pytest.mark.parametrize("name", sampled([*SCENES, "9.24-membrane", "9.9-patch"], 2))
def test_a_session_goes_to_rest_as_relax_does(client: httpx.Client, name: str) -> None:
    examples = [entry["id"] for entry in client.get("/v1/examples").json()["examples"]]
    if name in SCENES:
        scene = Scene.read(SCENES[name])
    else:
        [found] = [entry for entry in examples if entry.startswith(name.split("-")[0])][:1]
        scene = Scene.read(client.get(f"/v1/examples/{found}/scene").text)
    address = client.post("/v1/sessions", content=scene.canonical, headers=JSON).headers["location"]
    wanted, made = relax(scene), rested(client, address)
    assert np.array_equal(made["particles"], wanted.particles)
    assert (made["status"], made["message"]) == (str(wanted.status), wanted.message)
    assert client.get(address).json()["iteration"] == wanted.iterations
    client.delete(address)


def test_it_goes_to_rest_from_where_it_is(client: httpx.Client) -> None:
    """After frames and an edit: as `Simulation.relax` of a simulation with the same past."""
    edit = {"pin": [{"particles": [3], "targets": [[6, 1, 2]]}]}
    address = client.post("/v1/sessions", json=CABLE).headers["location"]
    client.post(f"{address}/step", params={"frames": 5})
    client.patch(address, json=edit)
    own = Simulation(Scene.read(CABLE))
    own.step(5)
    own.patch(edit)
    wanted, made = own.relax(), rested(client, address)
    assert np.array_equal(made["particles"], wanted.particles)
    client.delete(address)


def test_what_does_not_come_to_rest_is_edited_on_the_way_and_paused(client: httpx.Client) -> None:
    """A cable without damping, by a solver of physical time. It goes on after an edit; a pause stops it."""
    address = client.post("/v1/sessions", json=SWING).headers["location"]
    assert client.post(f"{address}/relax").json()["playing"]

    def on() -> int:
        return int(client.get(address).json()["iteration"])

    wait_for(lambda: on() > 0)
    edited = client.patch(address, json={"pin": [{"particles": [2], "targets": [[4, 0, 5]]}]}).json()
    assert edited["revision"] == 1 and edited["playing"]
    wait_for(lambda: on() > edited["iteration"])
    assert client.post(f"{address}/undo").json()["playing"]
    paused = client.post(f"{address}/pause").json()
    assert not paused["playing"] and paused["status"] == "running"
    state = client.get(f"{address}/state").json()
    assert np.isfinite(state["particles"]).all()
    assert client.get(f"{address}/state").json()["particles"] == state["particles"]
    stepped = client.post(f"{address}/step", params={"frames": 2}).json()
    assert stepped["iteration"] == paused["iteration"] + 2 * Scene.read(SWING).settings.sub_iterations
    client.delete(address)


def test_an_end_without_rest_is_no_end_of_play(client: httpx.Client) -> None:
    address = client.post("/v1/sessions", json=SCENES["unfinished"]).headers["location"]
    assert rested(client, address)["status"] == "max_iterations"
    stepped = client.post(f"{address}/step", params={"frames": 2}).json()
    assert stepped["status"] == "running" and stepped["iteration"] > 30
    assert rested(client, address)["status"] == "max_iterations"
    client.post(f"{address}/play")
    wait_for(lambda: client.get(address).json()["status"] == "converged")
    client.delete(address)


def test_a_session_whose_process_ends_goes_on_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Killed on the way: brought back, it relaxes on instead of playing."""
    call, asked = SessionProcess.call, []

    async def noted(process: SessionProcess, do: str, *given: Any, **options: Any) -> Any:
        answer = await call(process, do, *given, **options)
        asked.append(do)
        return answer

    async def brought_back() -> None:
        store = Store(None)
        manager = await opened(store, SWING)
        await manager.command("a", "relax")
        process = manager.find("a").process
        assert process is not None
        process.kill()
        while asked.count("relax") + asked.count("play") < 2:
            await asyncio.sleep(0.02)
        assert manager.find("a").playing
        await manager.close()
        store.close()

    monkeypatch.setattr(SessionProcess, "call", noted)
    asyncio.run(asyncio.wait_for(brought_back(), 60))
    assert "play" not in asked
