"""`irlx conformance`: the cases of a folder, for whoever implements the language."""

from __future__ import annotations

import argparse
from typing import Any

_EXAMPLE = "examples:\n  irlx conformance tests/conformance/lexical\n"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "conformance",
        help="run the conformance cases of a folder",
        description="Run the conformance cases below a folder, and tell which of them fail and how.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", metavar="DIR", help="folder of the cases: DIR/AREA/CASE/program.irl")
    parser.add_argument("--update", action="store_true", help="write the expectations of all cases anew")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print what fails and a line a folder on stdout; 1 where a case fails, 2 where there is none."""
    import sys
    from pathlib import Path

    from irlx.cli.output import encodable
    from irlx.conformance import find_cases, run_case, update_case

    cases = find_cases(Path(options.folder))
    if not cases:
        print(f"no cases below {options.folder}: a case is a folder with program.irl", file=sys.stderr)
        return 2
    if options.update:
        for case in cases:
            update_case(case)
    outcomes = [run_case(case) for case in cases]
    failed = [outcome for outcome in outcomes if not outcome.passed]
    for outcome in failed:
        print(encodable(f"FAILED {outcome.case.name}: {outcome.reason}", sys.stdout))
    areas: dict[str, list[bool]] = {}
    for outcome in outcomes:
        areas.setdefault(outcome.case.name.split("/", 1)[0], []).append(outcome.passed)
    for area, passed in areas.items():
        print(f"{area:<14}{sum(passed):>4} of {len(passed)}")
    must_fail = sum(case.must_fail for case in cases)
    print(f"{len(cases)} cases, {must_fail} of them must fail: {len(failed)} failed")
    return 1 if failed else 0
