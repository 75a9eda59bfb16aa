"""Whether this is `make soak`: tests marked `soak` run, and counts are in full."""

from __future__ import annotations

import os

SOAK = os.environ.get("HOOKEAN_SOAK") == "1"
