"""What holds for all tests."""

import os

# Small matrices gain nothing by threads, and two test processes at once lose much; as in `irlx` itself.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
