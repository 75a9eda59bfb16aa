"""Imported once by the fork server, so that every worker starts with warm kernels."""

from contextlib import suppress

from hookean_server.workers import warm

with suppress(Exception):
    warm()
