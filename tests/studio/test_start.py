"""The start page: who is let in, what it offers."""

from __future__ import annotations

from .browser import Studio


def test_the_page_comes_up(studio: Studio):
    assert studio.page.title()
