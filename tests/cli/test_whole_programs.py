"""Whole programs, run and verified: recursion, a scanner of texts, a matrix of poses."""

import numpy as np
import pytest

import irlx
from irlx.job import prepare
from irlx.pipeline import Execution

pytestmark = [pytest.mark.req("LANG-11"), pytest.mark.req("LANG-40")]

CELL = """[robot]
model = "koch11"
[robot.limits]
speed = [100, 100, 100, 100, 100, 100, 100, 100, 100, 1000, 100]
acceleration = [500, 500, 500, 500, 500, 500, 500, 500, 500, 5000, 500]
[motion]
tick_ms = 100
speed = 2000
acc = 4000
"""
ARM = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 50\n'
"""For what looks for postures, which takes long with eleven joints."""

HANOI = """PROGRAM p;
CONST REAL: thick := 20, apart := 300;
VAR POSE: base := ((11200, 700, 3300), ORIZYX(0, 0, 0));
    ARRAY [1..3] OF INT: height := (0, 0, 0);
    INT: i, moves := 0;

FUNCTION slot(INT: peg, level): POSE;
BEGIN
  RETURN base @ POSE(POSITION(0, apart * (peg - 1), thick * level), ORIQUAT(1, 0, 0, 0));
ENDFCT;

PROCEDURE carry(INT: start, into);
BEGIN
  MOVE LIN slot(start, height[start] - 1);
  height[start] := height[start] - 1;
  MOVE LIN slot(into, height[into]);
  height[into] := height[into] + 1;
  moves := moves + 1;
ENDPROC;

PROCEDURE tower(INT: discs, start, spare, into);
BEGIN
  IF discs > 0 THEN
    tower(discs - 1, start, into, spare);
    carry(start, into);
    tower(discs - 1, spare, start, into);
  ENDIF;
ENDPROC;

BEGIN
  height[1] := {discs};
  tower({discs}, 1, 2, 3);
  IF moves <> {moves} OR height[3] <> {discs} THEN
    HALT;
  ENDIF;
ENDPROGRAM
"""


def hanoi(discs):
    """Positions, m, that the tower of Hanoi calls for, by a recursion of Python's own."""
    height, found = [discs, 0, 0], []

    def at(peg):
        found.append((11.2, 0.7 + 0.3 * peg, 3.3 + 0.02 * height[peg]))

    def tower(count, start, spare, goal):
        if count:
            tower(count - 1, start, goal, spare)
            height[start] -= 1
            at(start)
            at(goal)
            height[goal] += 1
            tower(count - 1, spare, start, goal)

    tower(discs, 0, 1, 2)
    return found


@pytest.fixture
def program(tmp_path):
    def write(text, cell=CELL):
        (tmp_path / "p.toml").write_text(cell, encoding="utf-8")
        (tmp_path / "p.irl").write_text(text, encoding="utf-8")
        assert [str(found) for found in irlx.check(tmp_path / "p.irl") if found.is_error] == []
        return tmp_path / "p.irl"

    return write


def test_hanoi_gives_the_blocks_that_it_should(program):
    path = program(HANOI.format(discs=6, moves=63))
    blocks = list(Execution(prepare(path)).blocks())
    assert len(blocks) == 126
    positions = np.array([block.target.position for block in blocks])
    assert np.abs(positions - np.array(hanoi(6))).max() < 1e-12
    assert [block.id for block in blocks] == list(range(1, 127))


def test_hanoi_moves_the_robot(program):
    path = program(HANOI.format(discs=3, moves=7))
    run = irlx.run(path)
    assert run.complete
    ends = [np.flatnonzero(run.block == record.block.id)[-1] for record in run.stream.records]
    assert np.abs(run.tool[ends, :3] - np.array(hanoi(3))).max() < 1e-9
    assert irlx.verify(run, path).passed


SCANNER = """PROGRAM p;
VAR STRING: text := 'x+12 y-7 ; z3x  x9 ?y2', word := '', seen := '';
    INT: at := 1, number, sign; CHAR: axis, c;
    POSITION: here := (11500, 1000, 3500);

FUNCTION digit(CHAR: c): INT;
BEGIN
  RETURN ORD(c) - ORD('0');
ENDFCT;

PROCEDURE scan(VAR INT: number, at);
BEGIN
  number := 0;
  WHILE at <= LEN(text) DO
    IF text[at] < '0' OR text[at] > '9' THEN
      EXIT;
    ENDIF;
    number := 10 * number + digit(text[at]);
    at := at + 1;
  ENDWHILE;
ENDPROC;

BEGIN
  WHILE at <= LEN(text) DO
    c := text[at];
    at := at + 1;
    CASE c OF
      WHEN 'x'..'z':
        axis := c;
        sign := 1;
        IF at <= LEN(text) THEN
          CASE text[at] OF
            WHEN '+', '-':
              IF text[at] = '-' THEN
                sign := -1;
              ENDIF;
              at := at + 1;
          ENDCASE;
        ENDIF;
        scan(number, at);
        CASE axis OF
          WHEN 'x': here.x := here.x + sign * number;
          WHEN 'y': here.y := here.y + sign * number;
          DEFAULT: here.z := here.z + sign * number;
        ENDCASE;
        MOVE LIN here;
      WHEN ' ', ';':
      DEFAULT:
        seen := seen + c;
    ENDCASE;
  ENDWHILE;
  IF seen = '?' THEN
    HALT;
  ENDIF;
ENDPROGRAM
"""


def test_a_scanner_of_texts(program):
    blocks = list(Execution(prepare(program(SCANNER))).blocks())
    offsets = [(12, 0, 0), (12, -7, 0), (12, -7, 3), (12, -7, 3), (21, -7, 3), (21, -5, 3)]
    expected = (np.array([11500.0, 1000.0, 3500.0]) + np.array(offsets)) / 1000.0
    assert np.array([block.target.position for block in blocks[:-1]]) == pytest.approx(expected, abs=1e-12)
    assert type(blocks[-1]).__name__ == "HaltBlock"


MATRIX = """PROGRAM p;
CONST INT: n := 4;
TYPE ARRAY [1..n, 1..n] OF POSE = matrix;
VAR matrix: steps; INT: i, j;
    POSE: home := ((11500, 1000, 3500), ORIZYX(10, 20, 30)), at := home, back;
BEGIN
  FOR i := 1 TO n DO
    FOR j := 1 TO n DO
      steps[i, j] := POSE(POSITION(3 * i, -2 * j, i - j), ORIZYX(3 * i, 2 * j, i * j));
      at := at @ steps[i, j];
    ENDFOR;
  ENDFOR;
  MOVE LIN at;
  back := at;
  FOR i := n DOWNTO 1 DO
    FOR j := n DOWNTO 1 DO
      back := back @ INV(steps[i, j]);
    ENDFOR;
  ENDFOR;
  MOVE LIN back;
  MOVE LIN home;
ENDPROGRAM
"""


@pytest.mark.req("LANG-21")
@pytest.mark.req("LANG-31")
def test_a_matrix_of_poses_leads_back_to_where_it_began(program):
    _, back, home = Execution(prepare(program(MATRIX))).blocks()
    assert back.target.position == pytest.approx(home.target.position, abs=1e-12)
    assert back.target.orientation == pytest.approx(home.target.orientation, abs=1e-12)


QUESTIONS = """PROGRAM p;
VAR POSE: start := FK(R_JOINT_ACT), seen; MAIN_JOINT: j := R_JOINT_ACT.M_JOINT, k; REAL: x; INT: i;
BEGIN
  FOR i := 1 TO 2 DO
    MOVE LIN start + POSITION(100 * i, 0, 0);
    IF DISTANCE(R_ROBTARGET_ACT.PSE, FK(R_JOINT_ACT)) > 1E-9 THEN
      HALT;
    ENDIF;
  ENDFOR;
  x := MANIPULABILITY(j);
  IF x > 0 THEN
    MOVE LIN start + POSITION(x, 0, 0);
  ENDIF;
  PAUSE;
  {ik}
ENDPROGRAM
"""


@pytest.mark.req("LANG-34")
@pytest.mark.req("LANG-52")
def test_what_a_program_asks_of_the_machine(program):
    path = program(QUESTIONS.format(ik=""))
    run = irlx.run(path)
    blocks = [record.block for record in run.stream.records]
    assert [type(block).__name__ for block in blocks] == ["MoveBlock"] * 3 + ["PauseBlock"]
    assert blocks[2].target.position[0] - blocks[0].target.position[0] + 0.1 > 0.0
    report = irlx.verify(run, path)
    assert report.passed


@pytest.mark.req("LANG-34")
def test_ik_gives_the_posture_that_is_near(program):
    path = program(
        QUESTIONS.format(ik="k := IK(start, j); MOVE PTP k TIME := 3; MOVE PTP IK(start, k) TIME := 1;"),
        ARM,
    )
    run = irlx.run(path)
    assert np.abs(run.q[-1] - run.q[0]).max() < 1e-6
    assert irlx.verify(run, path).passed


def test_a_paused_program_survives_its_file(program, tmp_path):
    run = irlx.run(program("PROGRAM p; BEGIN CYCLICSTART; PAUSE; CYCLICEND; ENDPROGRAM"))
    run.save(tmp_path / "out.irdata")
    assert ", 380, " in (tmp_path / "out.irdata").read_text(encoding="utf-8")
    assert irlx.verify(tmp_path / "out.irdata", tmp_path / "p.irl").passed


@pytest.mark.req("LANG-53")
def test_a_run_tells_of_a_status_that_counts_for_nothing(program):
    """Once, at the first move to such a target, computed or not; without it nothing is told."""
    text = """PROGRAM p;
VAR ROBTARGET: t := ROBTARGET(FK(R_JOINT_ACT)); INT: i;
BEGIN
  FOR i := 0 TO 2 DO
    t.STATUS := 4 * i;
    MOVE LIN t;
  ENDFOR;
  MOVE PTP t;
ENDPROGRAM
"""
    run = irlx.run(program(text, ARM))
    (finding,) = run.diagnostics
    assert (finding.code, finding.place.line, finding.data["status"]) == ("IRL312", 6, 4)
    plain = text.replace("4 * i", "0 * i").replace("  MOVE PTP t;\n", "")
    assert irlx.run(program(plain, ARM)).diagnostics == ()


@pytest.mark.req("LANG-53")
def test_a_robtarget_moves_as_its_pose_does(program):
    """STATUS and TURNS are carried: the stream is that of the pose."""
    text = """PROGRAM p;
VAR POSE: q := FK(R_JOINT_ACT) + POSITION(-80, 20, 10); ROBTARGET: t; INT: i;
BEGIN
  t.PSE := q; t.STATUS := 3; FOR i := 1 TO 11 DO t.TURNS[i] := i; ENDFOR;
  MOVE LIN {target};
ENDPROGRAM
"""
    runs = [irlx.run(program(text.format(target=target))) for target in ("t", "q")]
    np.testing.assert_array_equal(runs[0].q, runs[1].q)
    assert [d.code for d in runs[0].diagnostics] == ["IRL312"]
