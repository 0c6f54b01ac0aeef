"""What nobody foresaw, as a diagnostic."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import Diagnostic, report

_CUT = "marshal data too short"
_OUT_OF_MEMORY = ("failed to map segment", "cannot allocate memory")


def fault(error: BaseException) -> Diagnostic:
    """IRL090 for an exception that is no IrlxError; what surrounds irlx is told as that, not as a fault."""
    if isinstance(error, MemoryError) or any(said in str(error).lower() for said in _OUT_OF_MEMORY):
        cause = "the memory that this process may use is used up"
        return report("IRL090", help="let it use more; a larger --tick needs less", cause=cause)
    cause = f"{type(error).__name__}: {error}"
    if isinstance(error, EOFError) and _CUT in str(error):
        # Python may keep what it could write of a module's bytecode, and reads it ever after.
        helps = "a full disk has cut Python's bytecode of a module: remove the folders __pycache__ of irlx"
        return report("IRL090", help=helps, cause=cause)
    return report("IRL090", cause=cause)
