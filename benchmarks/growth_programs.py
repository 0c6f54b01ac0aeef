"""Programs of any length and number of routines that run, and move little or not at all."""

from __future__ import annotations

HEAD = """PROGRAM long;
CONST REAL: gap := 2.5;
VAR
  INT: i, n := 0;
  REAL: sum := 0, width;
  BOOL: done := FALSE;
  POSITION: work := (441, 200, 324), place;
  ARRAY [0..23] OF REAL: rack;
"""
CALLED = """PROCEDURE count(IN INT: step; VAR INT: total);
BEGIN
  total := (total + step) MOD 1000;
ENDPROC;
"""
PIECE = """  { part @k@ }
  width := SQRT(@k@.) + gap * 0.5;
  rack[@k@ MOD 24] := width;
  place := work + POSITION(0, @x@, 0);
  IF width > 100. AND NOT done THEN
    sum := sum + width;
  ELSIF n > 900 THEN
    n := 0;
  ELSE
    sum := sum * 0.5;
  ENDIF;
  FOR i := 1 TO 3 DO
    n := n + i;
  ENDFOR;
  CASE n MOD 3 OF
    WHEN 0:
      sum := 1;
    DEFAULT:
      n := n + 1;
  ENDCASE;
  count(@k@, n);
"""
"""Twenty lines of ordinary statements."""
STILL, MOVING = "  done := n < 0;\n", "  MOVE LIN place;\n"
ROUTINE = """PROCEDURE routine_@k@(IN REAL: way; VAR REAL: total);
VAR REAL: half;
BEGIN
  half := way / 2.;
  total := total + half;
ENDPROC;
"""


def of_lines(lines: int, moves: bool) -> str:
    """A program of at least that many lines and at most 20 more; one in 21 of a long one moves by 1 mm."""
    text, length, number = [HEAD, CALLED, "BEGIN\n"], (HEAD + CALLED).count("\n") + 2, 0
    last = MOVING if moves else STILL
    while length < lines:
        piece = PIECE.replace("@k@", str(number % 5000)).replace("@x@", str(number % 2)) + last
        taken = piece.splitlines(keepends=True)
        if lines - length < len(taken):
            taken = ["  n := n + 1;\n"] * (lines - length)
        text += taken
        length += len(taken)
        number += 1
    return "".join(text) + "ENDPROGRAM;\n"


def of_routines(count: int) -> str:
    """A program with that many procedures, each called once."""
    declared = "".join(ROUTINE.replace("@k@", str(number)) for number in range(count))
    calls = "".join(f"  routine_{number}(1., sum);\n" for number in range(count))
    return f"{HEAD}{declared}BEGIN\n{calls}ENDPROGRAM;\n"
