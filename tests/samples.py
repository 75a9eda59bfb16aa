"""Scenes that several test files start from."""

from __future__ import annotations

from hookean import Scene, Settings
from hookean.commands.examples import figure


def cable(**settings: object) -> Scene:
    """Figure 9.11: span 10, five springs of length 2, loads of -20 z on all six particles, both ends held."""
    return figure("9.11-uneven-extension").scene().model_copy(update={"settings": Settings(**settings)})
