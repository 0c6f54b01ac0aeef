"""What nobody foresaw, as a diagnostic."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import Diagnostic, report

_OUT_OF_MEMORY = ("failed to map segment", "cannot allocate memory")


def fault(error: BaseException) -> Diagnostic:
    """IRL090 for an exception that is no IrlxError; a lack of memory is told as that, not as a fault."""
    if isinstance(error, MemoryError) or any(said in str(error).lower() for said in _OUT_OF_MEMORY):
        cause = "the memory that this process may use is used up"
        return report("IRL090", help="let it use more; a larger --tick needs less", cause=cause)
    return report("IRL090", cause=f"{type(error).__name__}: {error}")
