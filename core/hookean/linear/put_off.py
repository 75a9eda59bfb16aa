"""Parts of packages that load when they are first used, not when a package that never uses them starts.

SciPy's sparse matrices bring `from numpy import *` along. That loads parts of NumPy which neither of them uses, with
the compiler of Fortran among them, and takes twice as long as the rest of `import scipy.sparse`.
"""

from __future__ import annotations

import sys
from importlib.util import LazyLoader, find_spec, module_from_spec

NUMPY = ("f2py", "testing")  # not `ma` or others that two threads may ask for at the same moment


def put_off(package: str, parts: tuple[str, ...]) -> None:
    """Let these modules of a package load when something of them is first asked for; those that are loaded stay."""
    for part in parts:
        name = f"{package}.{part}"
        spec = None if name in sys.modules else find_spec(name)
        if spec is None or spec.loader is None:
            continue
        spec.loader = LazyLoader(spec.loader)
        module = module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)  # runs nothing of it yet
        setattr(sys.modules[package], part, module)
