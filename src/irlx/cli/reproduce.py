"""`irlx run --reproduce`: make a stream again, and say whether it is the same."""

from __future__ import annotations

import argparse
import sys

from irlx.cli.execution import import_plugins, standard_input

_OF_ITS_OWN = {"output": "-o", "tick": "--tick", "max_slow": "--max-slow", "max_steps": "--max-steps"} | {
    "explain_tick": "--explain-tick",
    "html": "--html",
    "pause": "--pause",
    "write_data": "--write-data",
}
"""Options that the file itself answers, or that make no sense beside it."""


def reproduced(options: argparse.Namespace) -> int:
    """Print what came of it; 1 where the stream is another one."""
    import json

    from irlx.cli.output import encodable, print_diagnostics
    from irlx.diagnostics import IrlxError, report
    from irlx.reproduction import reproduce

    for name, option in _OF_ITS_OWN.items():
        if getattr(options, name):
            given = getattr(options, name)
            value = str(given[0] if isinstance(given, list) else given)
            cause = "beside --reproduce only P, --cell, --inputs, --files and --plugin may be given"
            raise IrlxError(report("IRL006", option=option, value=value, cause=cause))
    import_plugins(options.plugin)
    found = reproduce(
        options.reproduce, options.program, options.cell, options.inputs, options.files, standard_input()
    )
    print_diagnostics(found.diagnostics)
    if options.json:
        plain = {
            "reproduced": found.reproduced,
            "same_bytes": found.same_bytes,
            "differences": list(found.differences),
            "software": found.software,
        }
        print(json.dumps(plain, indent=2))
    elif not options.quiet and found.reproduced:
        words = "the same bytes" if found.same_bytes else "the same header, blocks and samples"
        other = f"; made with {found.software}" if found.software else ""
        print(encodable(f"{'reproduced':<12}{found.path}: {words}{other}", sys.stdout))
    return 0 if found.reproduced else 1
