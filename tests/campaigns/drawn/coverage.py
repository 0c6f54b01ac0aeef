"""What a sample of drawn programs has to use: every rule of the grammar, option, clause and kind of robot."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from drawn.body import TICKS
from drawn.options import CRITERIA
from drawn.program import Case
from drawn.robots import KINDS
from drawn.script import LIMIT_WORDS
from irlx.language.lexing import lex
from irlx.language.source import decode_source

WANTED = (
    *(f"robot {kind}" for kind in KINDS),
    *(f"tick {tick} ms" for tick in TICKS),
    *(f"{n} joints" for n in range(3, 13)),
    *(f"switch {word}{end}" for word in LIMIT_WORDS.values() for end in ("", "END")),
    *(f"clause {word}" for word in (*LIMIT_WORDS.values(), "RECONFIGURATION", "TOLERANCE")),
    *(f"switch {word}" for word in ("CYCLICSTART", "CYCLICEND", "FREEZESTART", "FREEZEEND")),
    *(f"switch {word}" for word in ("OBSTACLE", "OBSTACLEEND", "CRITERIONEND")),
    *(f"switch CRITERION {name}" for name in CRITERIA),
    *(f"clause CRITERION {name}" for name in CRITERIA),
    *(f"parameter {word}" for word in ("SPEED", "ACC", "SPEED_ORI", "ACC_ORI", "SPEED_PTP", "ACC_PTP")),
    *(f"parameter {word}" for word in ("C_CP", "C_PTP", "C_PASS", "PROFILE", "JERK", "OVERRIDE", "TIME")),
    *("R_WEIGHTS", "R_SPEED", "R_C_PASS", "R_PROFILE", "in_base", "with_tool", "HALT"),
    *(f"move: {kind}" for kind in ("LIN to a pose", "LIN to several targets", "LIN to joints", "CIRCLE")),
    *(f"move: {kind}" for kind in ("LIN to a position", "CIRCLE by an angle", "LIN PATH", "SPLINE PATH")),
    *(
        f"move: {kind}"
        for kind in ("PTP to joints", "PTP to a pose", "MOVE_INC of joints", "RECONFIGURATION")
    ),
    *(f"move: {kind}" for kind in ("MOVE_INC by a position", "MOVE_INC by a pose", "to a ROBTARGET")),
    *(
        f"move: {kind}"
        for kind in ("IN FRAME that stands", "IN FRAME of a hand", "closed loop", "by a routine")
    ),
    *(f"goal: {kind}" for kind in ("where the tool is", "a residue away", "a turn on the spot", "the start")),
    *(f"goal: {kind}" for kind in ("huge", "on a limit", "joints at zero", "joints of the start")),
    *(f"goal: {kind}" for kind in ("joints and a residue", "some joints stay")),
    *(f"cell: {kind}" for kind in ("joints at zero", "start on a limit", "speed limit 0", "no limits")),
    *(f"cell: {kind}" for kind in ("relation of joints", "group of obstacles", "obstacle that moves")),
    *("limit where a joint stands", "speed bound 0", "data list", "module", "record", "array", "constant"),
)
"""Words that a sample must have noted, each once at least."""


def noted(cases: Iterable[Case]) -> Counter[str]:
    """How often each thing was written."""
    return sum((case.noted for case in cases), Counter())


def rules(cases: Iterable[Case], grammar) -> tuple[Counter[str], frozenset[str]]:
    """How often a parser reduces by each rule of the grammar over all texts, and the names of all rules."""
    used: Counter[str] = Counter()
    for case in cases:
        for name, text in case.files.items():
            if name.endswith((".irl", ".dat")):
                _count(grammar, decode_source(name, text.encode("utf-8")), used)
    names = (rule.origin.name for rule in grammar.rules)
    return used, frozenset(name for name in names if not name.startswith("__"))


def _count(grammar, source, used: Counter[str]) -> None:
    parser = grammar.parse_interactive()
    conf = parser.parser_state.parse_conf

    def noting(rule, build):
        def reduce(children):
            used[rule.origin.name] += 1
            return build(children)

        return reduce

    conf.callbacks = {rule: noting(rule, build) for rule, build in conf.callbacks.items()}
    for token in lex(source).tokens:
        parser.feed_token(token)
    parser.feed_eof()
