"""What a process loads once, so that its first answer is as quick as the others."""

from __future__ import annotations


def warm() -> None:
    """Load and compile what every solve needs, once: later workers inherit it or find it in the cache."""
    from hookean.running.run import relax
    from hookean.scene.scene import Scene

    scene = {
        "particles": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [2.0, 0.0, 0.0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]]},
            {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -1.0]},
        ],
        "anchors": [{"particles": [0, 2]}],
    }
    for settings in ({}, {"solver": "relaxation"}, {"solver": "verlet", "max_iterations": 10}):
        relax(Scene.model_validate({**scene, "settings": settings}))
    for name in (
        "hookean_server.workers.relax_task",
        "hookean_server.workers.discretize_task",
        "hookean.files.compas_json",
        "hookean.files.recipe.draft",
        "hookean.files.rhino.read",
        "scipy.spatial",  # near points, which most drawings need: it takes longer than all the others
    ):
        __import__(name)
