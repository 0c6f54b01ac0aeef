"""Loads the grammar's LALR tables, from a cache file where there is one."""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import tempfile
from collections.abc import Iterator
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import lark
from lark import Lark, Token

from irlx.language.builder import TreeBuilder
from irlx.language.grammar_text import grammar_text
from irlx.language.keywords import keyword_table

__all__ = ["build_grammar", "cache_file", "load_grammar"]

_DIGEST_SIZE = hashlib.sha256().digest_size


class _KeepForParser:
    """Names the terminals that no rule mentions; the parser takes them out of the stream itself."""

    always_accept = ("COMMENT", "WRONG_CHARACTER", "FOREIGN_COMMENT", "FOREIGN_SIGN", "FOREIGN_QUOTES")

    def process(self, stream: Iterator[Token]) -> Iterator[Token]:
        """Leaves the stream as it is."""
        return stream


def _run_time_options() -> dict[str, Any]:
    table = keyword_table()

    def retype(token: Token) -> Token:
        keyword = table.get(token.casefold())
        if keyword is not None:
            token.type = keyword
        return token

    return {
        "transformer": TreeBuilder(),
        "postlex": _KeepForParser(),
        "lexer_callbacks": {"NAME": retype},
    }


def build_grammar(*, debug: bool = False) -> Lark:
    """Compile the grammar from its text; `debug` makes Lark log every conflict."""
    return Lark(
        grammar_text(),
        parser="lalr",
        lexer="basic",
        keep_all_tokens=True,
        maybe_placeholders=False,
        debug=debug,
        **_run_time_options(),
    )


def cache_file() -> Path | None:
    """Where the compiled tables are kept, or None where the user has no folder for such files."""
    folder = os.environ.get("XDG_CACHE_HOME") or ""
    if not os.path.isabs(folder):
        home = os.environ.get("HOME") or os.environ.get("USERPROFILE") or ""
        if not os.path.isabs(home):
            return None
        folder = os.path.join(home, ".cache")
    identity = "\0".join((grammar_text(), lark.__version__, sys.version, keyword_identity()))
    digest = hashlib.sha256(identity.encode()).hexdigest()[:20]
    return Path(folder) / "irlx" / f"grammar-{digest}.tables"


def keyword_identity() -> str:
    """Text that changes when the options baked into the tables change."""
    return "keep_all_tokens, no placeholders, 1"


def _read_tables(path: Path) -> Lark | None:
    """Tables of a cache file, or None when it is missing, cut short or damaged."""
    try:
        content = path.read_bytes()
        digest, tables = content[:_DIGEST_SIZE], content[_DIGEST_SIZE:]
        if hashlib.sha256(tables).digest() != digest:
            return None
        # Lark.load() has no way to pass the transformer; `_load` is what its own cache calls.
        return Lark.__new__(Lark)._load(pickle.loads(tables), **_run_time_options())
    except Exception:
        # Whatever a strange file makes unpickling raise, compiling anew is the answer.
        return None


def _write_tables(grammar: Lark, path: Path) -> None:
    """Write a cache file in one step; silently does without where that is impossible."""
    temporary = ""
    try:
        buffer = BytesIO()
        grammar.save(buffer, exclude_options=("transformer", "postlex", "lexer_callbacks"))
        tables = buffer.getvalue()
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(tables).digest() + tables)
        os.replace(temporary, path)
    except OSError:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)


@lru_cache(maxsize=1)
def load_grammar() -> Lark:
    """The grammar, ready to parse; compiled once a process, or read from the cache file."""
    path = cache_file()
    if path is None:
        return build_grammar()
    grammar = _read_tables(path)
    if grammar is None:
        grammar = build_grammar()
        _write_tables(grammar, path)
    return grammar
