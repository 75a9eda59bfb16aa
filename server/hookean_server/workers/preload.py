"""Imported once by the fork server, so that every worker starts with warm kernels."""

import signal

# a terminal sends Ctrl-C to every process of the group; the service alone decides what it means
signal.signal(signal.SIGINT, signal.SIG_IGN)

import logging  # noqa: E402

from hookean_server.http import logs  # noqa: E402
from hookean_server.workers.warm import warm  # noqa: E402

logs.begin()
try:
    warm()
except Exception:  # each worker compiles what it needs by itself
    logging.getLogger("hookean.worker").exception("the kernels could not be loaded beforehand")
