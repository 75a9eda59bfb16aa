"""rhino3dm without its type stubs, which lack members and name arguments that it does not have."""

from __future__ import annotations

from typing import Any

import rhino3dm as module

rhino3dm: Any = module
