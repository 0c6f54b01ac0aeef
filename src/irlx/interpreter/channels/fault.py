"""What goes wrong with a file or channel, before it is known which part of the program asked for it."""

from __future__ import annotations

from typing import Any

from irlx.diagnostics import Related

STANDARD_IN, STANDARD_OUT = "STANDARD_IN", "STANDARD_OUT"
"""What messages call the standard channels."""


class ChannelFault(Exception):
    """A code of the catalogue with the data of its message; whoever has the place makes an error of it."""

    def __init__(self, code: str, related: tuple[Related, ...] = (), **data: Any) -> None:
        super().__init__(code)
        self.code, self.related, self.data = code, related, data


def cannot(name: str, done: str, cause: OSError | str) -> ChannelFault:
    """IRL548: a file that cannot be `done`, such as opened, and why."""
    shown = name if name in (STANDARD_IN, STANDARD_OUT) else f"'{name}'"
    words = cause if isinstance(cause, str) else (cause.strerror or str(cause)).lower()
    return ChannelFault("IRL548", name=shown, done=done, cause=words)
