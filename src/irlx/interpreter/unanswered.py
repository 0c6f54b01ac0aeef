"""A value that only the machine can tell."""

from __future__ import annotations

from irlx.blocks import AskPostureOf


class Unanswered(Exception):
    """An expression has no value before the machine has answered `question`; it is evaluated again then."""

    def __init__(self, question: AskPostureOf) -> None:
        super().__init__(question)
        self.question = question
