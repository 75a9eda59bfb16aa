"""Running machines of hypothesis against a server of their own."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, settings
from hypothesis.stateful import run_state_machine_as_test


def agrees_with_its_model(machine: Any, runs: int, steps: int) -> None:
    """So many runs of at most so many steps; `machine.state` is where the sessions are, `machine.served` its server,
    which is ended afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        machine.state = str(Path(folder) / "sessions.db")
        chosen = settings(
            max_examples=runs,
            stateful_step_count=steps,
            deadline=None,
            database=None,
            phases=[Phase.generate, Phase.shrink],
            suppress_health_check=list(HealthCheck),
        )
        try:
            run_state_machine_as_test(machine, settings=chosen)
        finally:
            if machine.served is not None:
                machine.served.end()
                machine.served = None
