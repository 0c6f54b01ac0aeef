"""What makes a cell of a notebook fail whose program did not begin."""

from __future__ import annotations

import re

from irlx.diagnostics import IrlxError
from irlx.diagnostics.text import render_text

_SEVERITY = re.compile(r"\berror IRL\d{3}\b")
_BOLD_RED, _PLAIN = "\x1b[1;31m", "\x1b[0m"


class NotBegun(IrlxError):
    """The findings that kept a program from its begin: the cell fails, and the cells behind it do not run."""

    def _render_traceback_(self) -> list[str]:
        """What IPython shows in the place of a traceback: line, excerpt and caret of each finding."""
        texts = (render_text(found) for found in self.diagnostics)
        return [_SEVERITY.sub(rf"{_BOLD_RED}\g<0>{_PLAIN}", text, count=1) for text in texts]
