"""The grammar as Lark compiles it, which the tables that irlx ships are made from."""

from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

GRAMMAR = Path(__file__).parents[2] / "grammar"

_spec = spec_from_file_location("make_tables", GRAMMAR / "make_tables.py")
make_tables = module_from_spec(_spec)
_spec.loader.exec_module(make_tables)
build_grammar = cache(make_tables.build_grammar)
"""It takes a third of a second: built once, and changed by nobody."""
