"""The first thing that runs. It imports nothing: what is being loaded cannot answer to Ctrl-C."""

import sys


def entry_point() -> None:
    """Console entry: `irlx`."""
    try:
        from irlx.cli.main import entry_point as carried_out
    except KeyboardInterrupt:
        print("irlx: interrupted", file=sys.stderr)
        sys.exit(130)
    carried_out()
