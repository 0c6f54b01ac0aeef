"""The server behind the page: on one port of one address, with no way out to other hosts."""

from __future__ import annotations

import errno
import io
import os
import socket
import threading
from contextlib import redirect_stdout
from dataclasses import dataclass
from typing import Any

from irlx.diagnostics import IrlxError, report
from irlx.diagnostics.extra import require_extra

DEFAULT_PORT = 8080
_TRIED = 20
"""Ports that are tried from the default one on, where none is asked for."""


def require_viewer() -> None:
    """Raises IrlxError, IRL010, where the package that serves the page is missing."""
    require_extra("irlx view", "view", "viser")


def free_port(host: str, port: int | None) -> int:
    """The port to serve on: the one asked for, else the first one from the default on that is free.

    Raises IrlxError: IRL006 for what is no port, IRL014 for one that cannot be served on.
    """
    if port is not None and not 0 <= port <= 65535:
        raise IrlxError(report("IRL006", option="--port", value=str(port), cause="a port is 0 to 65535"))
    wanted = range(DEFAULT_PORT, DEFAULT_PORT + _TRIED) if port is None else (port,)
    cause: OSError | None = None
    for number in wanted:
        try:
            return _bound(host, number)
        except (OSError, UnicodeError) as error:
            cause = error if isinstance(error, OSError) else OSError("no such host")
            if cause.errno != errno.EADDRINUSE:
                break
    words = "it is in use" if cause and cause.errno == errno.EADDRINUSE else _words(cause)
    where = f"port {wanted[0]}" if len(wanted) == 1 else f"ports {wanted[0]} to {wanted[-1]}"
    raise IrlxError(report("IRL014", where=where, host=host, cause=words))


def _bound(host: str, port: int) -> int:
    """The port, 0 replaced by one that is free. Raises OSError where it cannot be bound."""
    family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        if os.name == "posix":
            # As servers do: a port whose last owner has just gone is free.
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(address)
        return int(probe.getsockname()[1])


def _words(cause: OSError | None) -> str:
    if cause is None:
        return "it cannot be served on"
    return cause.strerror or str(cause)


@dataclass(frozen=True)
class PageServer:
    """A viser `server` that is running, and the threads that it has begun."""

    server: Any
    threads: tuple[threading.Thread, ...]

    def stop(self) -> None:
        """End it without a word on stdout; its threads say the last one, so that they are waited for."""
        with redirect_stdout(io.StringIO()):
            self.server.stop()
            for thread in self.threads:
                thread.join(timeout=10.0)


def serve(host: str, port: int, label: str) -> PageServer:
    """A viser server without its own words on stdout and without the tunnel to other hosts that it offers.

    Raises IrlxError, IRL014, where somebody else has taken the port by now.
    """
    import viser

    before = set(threading.enumerate())
    with redirect_stdout(io.StringIO()):
        server: Any = viser.ViserServer(host=host, port=port, label=label, verbose=False)
    found = PageServer(server, tuple(set(threading.enumerate()) - before))
    if server.get_port() != port:
        found.stop()
        raise IrlxError(report("IRL014", where=f"port {port}", host=host, cause="it is in use"))
    # Any page that is connected may ask for the tunnel: what is seen here stays on this machine.
    server.request_share_url = lambda verbose=True: None
    server.gui.configure_theme(
        control_width="large",
        show_logo=False,
        show_share_button=False,
        brand_color=(46, 125, 214),
    )
    server.gui.main_panel.dock_right()
    return found
