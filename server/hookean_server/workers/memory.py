"""How much memory a process takes, and when it gives memory back to the system."""

from __future__ import annotations

import sys
from contextlib import suppress


def limit_memory(memory: int) -> None:
    """At most `memory` bytes more than now, where the system can hold us to it; and no memory left in a core file."""
    if sys.platform != "linux":
        return
    with suppress(OSError, ValueError):
        import resource

        with open("/proc/self/statm", encoding="ascii") as file:
            now = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (now + memory, now + memory))


def return_pages() -> None:
    """Give the memory of large values back to the system as soon as they are gone, not when its neighbours are."""
    if sys.platform != "linux":
        return
    with suppress(OSError, AttributeError):  # other C libraries than glibc do not have it
        import ctypes

        ctypes.CDLL(None).mallopt(-3, 256 * 2**10)  # M_MMAP_THRESHOLD; set once, it does not grow


def keep_pages() -> None:
    """Take arrays up to 64 MB from memory that was used before: fresh pages cost more than the sums on them."""
    if sys.platform != "linux":
        return
    with suppress(OSError, AttributeError):  # other C libraries than glibc do not have it
        import ctypes

        libc = ctypes.CDLL(None)
        libc.mallopt(-3, 64 * 2**20)  # M_MMAP_THRESHOLD
        libc.mallopt(-1, 256 * 2**20)  # M_TRIM_THRESHOLD
