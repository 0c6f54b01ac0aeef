"""A figure that looks the same whoever saves it."""

from __future__ import annotations

import os
from io import BytesIO
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.linewidth": 0.6,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "axes.unicode_minus": True,
    # Letters as outlines: a picture is the same where the font is not installed.
    "svg.fonttype": "path",
    "svg.hashsalt": "irlx",
    "pdf.fonttype": 42,
}
"""Settings of matplotlib in which figures of irlx are made and saved, whatever the user's own are."""

DOTS = 150
"""Dots per inch of a saved picture."""
_ON_SCREEN = 96
_UNDATED: dict[str, dict[str, Any]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}


class StyledFigure(Figure):
    """A figure of matplotlib in the style of irlx; notebooks show it without pyplot."""

    def savefig(self, fname: Any, *, transparent: bool | None = None, **options: Any) -> None:
        """Like that of matplotlib; without date, so that the same figure gives the same bytes."""
        ending = os.path.splitext(fname)[1][1:] if isinstance(fname, str | os.PathLike) else ""
        form = str(options.get("format") or ending).lower()
        undated = {"metadata": _UNDATED[form]} if form in _UNDATED else {}
        with mpl.rc_context(STYLE):
            super().savefig(fname, transparent=transparent, **{"dpi": DOTS, **undated, **options})

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        picture = BytesIO()
        self.savefig(picture, format="png", dpi=_ON_SCREEN)
        return picture.getvalue()
