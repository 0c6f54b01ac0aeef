"""Runs that several tests look at, each made once a process: a run depends on its files and options alone."""

from __future__ import annotations

from collections import OrderedDict
from pathlib import Path

import irlx
from irlx.verifier import Report

_MOST = 32
_runs: OrderedDict[tuple, irlx.Run] = OrderedDict()
_reports: OrderedDict[tuple, Report] = OrderedDict()


def kept_run(program: Path, cell: Path, **options: object) -> irlx.Run:
    """The run of a program that imports nothing and a cell of a packaged robot; nobody may change it.

    Places in its diagnostics name the files of whoever asked first.
    """
    return _kept(_runs, _key(program, cell, options), lambda: _ran(program, cell, options))


def kept_report(program: Path, cell: Path, **options: object) -> Report:
    """The verifier's report on that run, with its program and its cell."""
    run = kept_run(program, cell, **options)
    return _kept(_reports, _key(program, cell, options), lambda: irlx.verify(run, program=program, cell=cell))


def _ran(program: Path, cell: Path, options: dict) -> irlx.Run:
    run = irlx.run(program, cell=cell, **options)
    for array in (run.stream.q, run.stream.ticks, run.stream.block, run.stream.tool):
        array.flags.writeable = False
    return run


def _key(program: Path, cell: Path, options: dict) -> tuple:
    return program.name, program.read_bytes(), cell.name, cell.read_bytes(), *sorted(options.items())


def _kept(known: OrderedDict, key: tuple, make) -> object:
    if key not in known:
        known[key] = make()
        if len(known) > _MOST:
            known.popitem(last=False)
    known.move_to_end(key)
    return known[key]
