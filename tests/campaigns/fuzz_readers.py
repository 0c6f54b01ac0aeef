"""Damaged streams, cells, robots, meshes and inputs through all that read them.

    python tests/campaigns/fuzz_readers.py                       on to 100,000 inputs, from where it stopped
    python tests/campaigns/fuzz_readers.py --seconds 600         for ten minutes
    python tests/campaigns/fuzz_readers.py --seed 7 --anew       another campaign
    python tests/campaigns/fuzz_readers.py --case FILE...        look at saved cases

See `docs/quality.md`, Fuzzing.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from fuzzing.command import main
from fuzzing.readers import ReadersJudge

if __name__ == "__main__":
    sys.exit(main("fuzz_readers", __doc__ or "", ReadersJudge, 100_000, 2_500))
