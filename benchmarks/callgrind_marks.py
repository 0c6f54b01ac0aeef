"""Tells Valgrind from inside a Python process where counting begins and ends.

Valgrind understands requests that are written as instructions without effect (its manual, "The Client
Request mechanism"): rotations of a register that add up to a full turn, then an exchange of a register with
itself, the address of six words in `rax` and the default answer in `rdx`. Without Valgrind they do nothing.
Python has no compiler at hand, so the few bytes for x86-64 are written into executable memory.
"""

from __future__ import annotations

import ctypes
import mmap
import platform
from collections.abc import Iterator
from contextlib import contextmanager

_REQUEST = bytes.fromhex(
    "4889f8"  # mov rax, rdi: the first argument of the C call, address of the words
    "31d2"  # xor edx, edx: the answer outside of Valgrind
    "48c1c703 48c1c70d 48c1c73d 48c1c733"  # rol rdi by 3, 13, 61, 51
    "4887db"  # xchg rbx, rbx
    "4889d0"  # mov rax, rdx
    "c3"  # ret
)
_CALLGRIND = ord("C") << 24 | ord("T") << 16
_DUMP, _START, _STOP = _CALLGRIND + 3, _CALLGRIND + 4, _CALLGRIND + 5


class Marks:
    """Requests to Valgrind from this process. RuntimeError on machines other than x86-64."""

    def __init__(self) -> None:
        if platform.machine().lower() not in ("x86_64", "amd64"):
            raise RuntimeError("instructions are counted on x86-64 only")
        self._memory = mmap.mmap(-1, mmap.PAGESIZE, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
        self._memory.write(_REQUEST)
        address = ctypes.addressof(ctypes.c_char.from_buffer(self._memory))
        self._call = ctypes.CFUNCTYPE(ctypes.c_uint64, ctypes.c_void_p)(address)

    @contextmanager
    def counted(self, name: str) -> Iterator[None]:
        """What is done inside is counted, and the count written to a file of its own that bears the name.

        Nothing else is, where Callgrind was begun with `--instr-atstart=no`.
        """
        words = ctypes.create_string_buffer(name.encode())
        self._ask(_START)
        try:
            yield
        finally:
            self._ask(_STOP)
            self._ask(_DUMP, ctypes.addressof(words))

    def _ask(self, request: int, argument: int = 0) -> None:
        words = (ctypes.c_uint64 * 6)(request, argument)
        self._call(ctypes.addressof(words))
