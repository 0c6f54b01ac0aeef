"""What each piece of a program text is, for those who colour it: editors, terminals, web pages."""

from irlx.language.highlight.kind import Kind
from irlx.language.highlight.pieces import Piece, pieces

__all__ = ["Kind", "Piece", "pieces"]
