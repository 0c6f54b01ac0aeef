"""Too little memory for the numeric libraries, found before they are loaded."""

from __future__ import annotations

import mmap
import resource
import sys

__all__ = ["expect_little_memory"]

_NEEDED = {"numpy": 78 << 20, "scipy": 175 << 20}
"""Address space, bytes, that `irlx run` takes at least from the moment on at which these are loaded; somewhat
less than was measured. Some of it is asked for only where a matrix is factored for the first time."""


def expect_little_memory() -> None:
    """Where the address space is limited (``ulimit -v``), let imports of the numeric libraries fail in time.

    A library of linear algebra that gets no memory while it is loaded ends the process in words of its own,
    or tries for ever.
    """
    if resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY:
        sys.meta_path.insert(0, _Doorkeeper())


class _Doorkeeper:
    """A finder of modules that finds none; raises MemoryError where there is no room for one."""

    def find_spec(self, name: str, *_: object) -> None:
        """Called by Python for every module that is to be loaded."""
        if name in _NEEDED:
            _try_room(_NEEDED[name])


def _try_room(size: int) -> None:
    """Raises MemoryError where so many bytes cannot be had; none is touched."""
    try:
        mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS).close()
    except OSError as cause:
        raise MemoryError from cause
