"""How an evaluation can end before its time."""

from __future__ import annotations


class Trouble(Exception):
    """A run-time error of the language: its code and the node of the tree that it belongs to."""

    def __init__(self, code, node):
        super().__init__(code)
        self.code = code
        self.span = (node.span.start, node.span.end)


class TooLong(Exception):
    """The program runs longer than a comparison is worth."""
