"""What tests of structures have in common."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .balances import balanced

STRUCTURES = {
    "analysis", "area_weight", "beam", "beam_buckling", "beam_mechanisms", "beam_paths", "beam_units", "cables",
    "constant_tension", "exact_reactions", "frame_buckling", "hydrostatic", "hypar_roof", "kratos", "line_weight",
    "load_cases", "lost_loads", "materials", "membrane", "obstacle_course", "patterns", "shell", "sliding_cable",
    "support", "prestress_factor", "temperature", "truss_buckling", "utilisation", "wind_pressure",
}  # fmt: skip
"""Files of tests in which loads and reactions of all that comes to rest balance (see `balances`)."""


@pytest.fixture(autouse=True)
def reactions_and_loads_balance(request: pytest.FixtureRequest) -> Iterator[None]:
    """Forces and moments, to 1e-9 of their scale, in each test of structures."""
    if request.path.stem.removeprefix("test_") not in STRUCTURES:
        yield
        return
    with balanced():
        yield
