"""Long programs as people write them: indented, commented, every kind of statement, without a mistake."""

import random

HEAD = """\
PROGRAM cell_{number};
{{ Loads parts from a rack, welds them and puts them on a belt. }}
SYSTEM SPECIFICATION line;
TYPE
  RECORD
    REAL: a1, a2, a3, a4, a5, a6, a7;
  ENDRECORD = MAIN_JOINT;
  RECORD
    INT: number;
    REAL: width, height;
    BOOL: good;
  ENDRECORD = part_data;
CONST
  REAL: lift := 120., gap := 2.5;
  INT: rows := 4, columns := 6;
VAR
  POSE: p1, p2, p3 := ((600, 0, 400), ORIZYX(0, 180, 0));
  POSITION: corner := (100., 200., 300.), shift;
  ARRAY [1..24] OF POSITION: rack;
  ARRAY [1..4, 1..6] OF INT: filled;
  MAIN_JOINT: home := (0, -30, 90, 0, 60, 0, 0), folded;
  MAIN_JOINT_MIN: lower;
  MAIN_JOINT_MAX: upper;
  part_data: part;
  INT: i, j, n, count := 0;
  REAL: speed, angle, sum;
  BOOL: ready, done;
  STRING: message;
  INPUT BOOL: part_present AT 3;
  OUTPUT BOOL: gripper AT 1;
"""

ROUTINES = (
    """\
PROCEDURE pick_{n}(IN POSITION: place; VAR INT: taken);
VAR
  REAL: slow;
BEGIN
  slow := 100. + gap;
  MOVE LIN place + POSITION(0, 0, lift) SPEED := 500.;
  MOVE LIN place SPEED := slow;
  gripper := TRUE;
  WAIT 0.2 SEC;
  MOVE LIN place + POSITION(0, 0, lift);
  taken := taken + 1;
ENDPROC;
""",
    """\
FUNCTION above_{n}(POSITION: place; REAL: height): POSITION;
BEGIN
  IF height < 0. THEN
    RETURN place;
  ENDIF;
  RETURN place + POSITION(0, 0, height);
ENDFCT;
""",
    """\
PROCEDURE report_{n};
BEGIN
  WRITE('parts: ', count:6);
  WRITELN(' of ', rows * columns);
ENDPROC;
""",
)

PIECES = (
    """\
  { approach from above }
  MOVE LIN rack[{k}] + POSITION(0, 0, lift) SPEED := {v}.;
  MOVE LIN rack[{k}] SPEED := {v}. ACC := 500.;
  gripper := TRUE;
  WAIT 0.5 SEC;
""",
    """\
  speed := {v}. * gap + 3;
  sum := sum + speed / 2.;
  angle := angle + {k} * 0.5;
""",
    """\
  IF count > {k} AND ready THEN
    count := 0;
    message := 'rack is full';
  ELSIF count = {k} THEN
    message := 'last part';
  ELSE
    count := count + 1;
  ENDIF;
""",
    """\
  FOR i := 1 TO columns DO
    FOR j := 1 TO rows DO
      filled[j, i] := i * {k} + j;
      IF filled[j, i] > 20 THEN
        sum := sum + 1.;
      ENDIF;
    ENDFOR;
  ENDFOR;
""",
    """\
  n := 0;
  WHILE n < {k} DO
    n := n + 1;
    shift := corner * 2. + POSITION(1, 2, 3);
  ENDWHILE;
""",
    """\
  REPEAT
    n := n - 1;
    done := n <= 0;
  UNTIL done;
""",
    """\
  CASE n OF
    WHEN 1, 3:
      speed := 100.;
    WHEN 4..{k}:
      speed := 200.;
      gripper := FALSE;
    DEFAULT:
      HALT;
  ENDCASE;
""",
    """\
  CYCLICSTART;
  MOVE PTP home SPEED_PTP := 50;
  MOVE CIRCLE p1, p2 SPEED := {v}.;
  CYCLICEND;
""",
    """\
  JOINTLIMIT lower, upper;
  FREEZESTART 2, 3;
  MOVE LIN p1, p2, p3 SPEED := {v}. WITH RECONFIGURATION home, folded, home;
  FREEZEEND;
  JOINTLIMITEND;
""",
    """\
  (* go round the fixture *)
  OBSTACLE fixture;
  MOVE LIN ((600, {k}, 400), ORIZYX(0, 180, 0)) WITH CRITERION manipulability WEIGHT := 2;
  OBSTACLEEND fixture;
  RECONFIGURATION folded;
""",
    """\
  part.number := {k};
  part.width := SQRT(ABS(sum)) + SIN(angle);
  part.good := NOT done AND (part.width >= gap) OR ready;
  p2 := p1 @ POSE(POSITION(0, 0, {k}), ORIQUAT(1, 0, 0, 0));
""",
    """\
  WAIT FOR part_present TIMEOUT 5 SEC;
  pick_0(rack[{k}], count);
  shift := above_0(rack[{k}], lift);
  report_0;

""",
)


def long_program(lines, seed=0):
    """Text of a program of at least `lines` lines, at most a piece more."""
    chance = random.Random(seed)
    text = [HEAD.format(number=seed)]
    length = text[0].count("\n") + 3
    for number in range(max(lines // 500, 1)):
        for routine in ROUTINES:
            text.append(routine.replace("{n}", str(number)))
            length += routine.count("\n")
    text.append("BEGIN\n  count := 0;\n")
    while length < lines:
        piece = chance.choice(PIECES)
        text.append(
            piece.replace("{k}", str(chance.randint(5, 24))).replace("{v}", str(chance.randint(50, 900)))
        )
        length += piece.count("\n")
    return "".join(text) + "ENDPROGRAM;\n"
