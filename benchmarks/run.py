"""python benchmarks/run.py [--only NAME ...] [--sizes N ...] [--out FILE]: bench.py has what is measured, and how."""

from __future__ import annotations

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"  # before anything imports numpy or numba

if __name__ == "__main__":
    from bench import main

    main()
