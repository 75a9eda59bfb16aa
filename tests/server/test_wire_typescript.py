"""studio/src/wire.ts, by which the page reads frames, is what wire.py says."""

from __future__ import annotations

from pathlib import Path

from hookean_server.sessions.wire_typescript import typescript

MODULE = Path(__file__).parents[2] / "studio" / "src" / "wire.ts"


def test_the_page_reads_the_frames_that_are_sent() -> None:
    assert MODULE.read_text("utf-8") == typescript(), (
        "write it anew: python -m hookean_server.sessions.wire_typescript > studio/src/wire.ts"
    )
