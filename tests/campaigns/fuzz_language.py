"""Damaged programs through parser, checker, renderers and formatter.

    python tests/campaigns/fuzz_language.py                    on to 1,000,000 inputs, from where it stopped
    python tests/campaigns/fuzz_language.py --seconds 600         for ten minutes
    python tests/campaigns/fuzz_language.py --seed 7 --anew       another campaign
    python tests/campaigns/fuzz_language.py --case FILE...        look at saved cases

See `docs/quality.md`, Fuzzing.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from fuzzing.command import main
from fuzzing.language import LanguageJudge

if __name__ == "__main__":
    sys.exit(main("fuzz_language", __doc__ or "", LanguageJudge, 1_000_000, 5_000))
