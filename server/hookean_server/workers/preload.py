"""Imported once by the fork server, so that every worker starts with warm kernels."""

import signal

# a terminal sends Ctrl-C to every process of the group; the service alone decides what it means
signal.signal(signal.SIGINT, signal.SIG_IGN)

from contextlib import suppress  # noqa: E402

from hookean_server.http import logs  # noqa: E402
from hookean_server.workers.warm import warm  # noqa: E402

logs.begin()
with suppress(Exception):
    warm()
