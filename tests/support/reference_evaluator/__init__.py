"""A slow and obvious evaluator of programs, written from docs/reference/language.md alone.

It walks the tree of irlx's parser and shares nothing else with irlx. Motion, signals, files and what asks the
robot are not in it.

`evaluated` says what a program leaves in its variables, what it writes, and the error it ends in.
"""

from reference_evaluator.program import Ending, evaluated
from reference_evaluator.trouble import TooLong, Trouble

__all__ = ["Ending", "TooLong", "Trouble", "evaluated"]
