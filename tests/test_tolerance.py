"""WITH TOLERANCE: the tool stands off its pose within bands, which sets joints free.

Where the tool stands is measured with the verifier's forward kinematics and SciPy's rotations, against paths
that are written down here.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.load import load_cell
from irlx.streams import BlockRecord, JointStream, read_stream
from irlx.verifier import verify_stream
from irlx.verifier.geometry.forward import forward
from long_run import chequered, first, first_rows

pytestmark = [pytest.mark.req("LANG-66"), pytest.mark.req("TRF-21")]

FOLDER = Path(__file__).parents[1] / "programs" / "free_turn"
CELL = """[robot]
model = "rail6"
locked = { rail_joint = 150 }
start = [8, 25, 15, 10, 45, -8]
[robot.limits]
acceleration = [400, 400, 500, 900, 900, 1200]
[robot.self_collision]
active = false
[motion]
tick_ms = 40
speed = 200
acc = 1000
"""
"""Distances of links are looked at in the programs of the folder."""
TURN = "WITH TOLERANCE (0, 0, 0, 0, 0, 360)"
SIDES = ((0, 150, 0), (0, 0, -150), (0, -150, 0), (0, 0, 150))
BAND = 1e-9
HERE = "R_ROBTARGET_ACT.PSE"
ROUND = f"{HERE} + POSITION(0, 50, 50), {HERE} + POSITION(0, 100, 0)"


def square(clause: str) -> str:
    return "".join(f"  MOVE_INC LIN {side} {clause};\n" for side in SIDES)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tolerance")

    @cache
    def made(body: str, cell: str = CELL) -> irlx.Run:
        (folder / "p.irl").write_text(f"PROGRAM p;\nVAR ROBTARGET: home;\nBEGIN\n{body}ENDPROGRAM\n")
        (folder / "p.toml").write_text(cell)
        found = irlx.run(folder / "p.irl")
        report = irlx.verify(found, program=folder / "p.irl", cell=folder / "p.toml")
        assert report.passed, str(report)
        return found

    made.robot = lambda: load_cell(folder / "p.toml").robot  # type: ignore[attr-defined]
    return made


def tool(run, found: irlx.Run) -> tuple[np.ndarray, np.ndarray]:
    position, rotation = forward(run.robot(), found.q)
    return position, rotation


def standing(run, found: irlx.Run) -> np.ndarray:
    """Coordinates (N, 6) of the tool in the poses of the square: m, rad about x, y, z."""
    position, rotation = tool(run, found)
    base = rotation[0]
    corners = position[0] + np.vstack([np.zeros(3), np.cumsum(SIDES, axis=0)]) * 1e-3
    place = np.empty_like(position)
    for number in range(4):
        rows = np.flatnonzero(found.block == number + 1)
        step = corners[number + 1] - corners[number]
        share = np.clip((position[rows] - corners[number]) @ step / (step @ step), 0.0, 1.0)
        place[rows] = corners[number] + share[:, None] * step
    place[found.block == 0] = corners[0]
    turns = Rotation.from_matrix(base.T @ rotation).as_euler("ZYX")[:, ::-1]
    return np.hstack([(position - place) @ base, turns])


def travel(found: irlx.Run) -> float:
    """Way of all joints together, degrees."""
    return float(np.degrees(np.abs(np.diff(found.q, axis=0)).sum()))


def test_a_free_turn_moves_the_joints_less(run) -> None:
    fixed, free = run(square("")), run(square(TURN))
    assert travel(fixed) == pytest.approx(191.2, abs=0.5)
    assert travel(free) < 0.85 * travel(fixed)
    found = standing(run, free)
    assert np.abs(found[:, :5]).max() < BAND
    assert np.degrees(np.ptp(found[:, 5])) > 5.0


def test_what_is_asked_for_exactly_stays_so(run) -> None:
    assert np.abs(standing(run, run(square("")))).max() < BAND
    zeros = run(square("WITH TOLERANCE (0, 0, 0, 0, 0, 0)"))
    assert np.allclose(zeros.q, run(square("")).q, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(
    "bands", first(2, [(0, 0, 2, 0, 0, 0), (0, 0, 3, 2, 2, 2), (0, 0, 0, 5, 5, 0), (0, 0, 0, 5, 5, 360)])
)
def test_bands_hold_and_are_used(run, bands: tuple[int, ...]) -> None:
    found = standing(run, run(square(f"WITH TOLERANCE {bands}")))
    most = np.array([*(band * 1e-3 for band in bands[:3]), *np.radians(bands[3:])])
    # The depth is not along any side: the nearest point of the path is where the tool is asked to be.
    exact = np.flatnonzero((most == 0.0) & (np.arange(6) >= 3))
    assert np.abs(found[:, exact]).max(initial=0.0) < BAND
    turns = np.arange(3, 6)
    assert np.all(np.abs(found[:, turns]).max(axis=0) <= most[turns] + BAND)
    reached = np.abs(found).max(axis=0)
    assert np.any(reached[most > 0.0] > 0.2 * np.minimum(most[most > 0.0], 0.1))


@pytest.mark.parametrize("clause", first(1, [TURN, "WITH TOLERANCE (0, 0, 0, 5, 5, 0)"]))
def test_the_posture_closes(run, clause: str) -> None:
    for body in (square(clause), square(clause) * 2):
        found = run(f"CYCLICSTART;\n{body}CYCLICEND;\n")
        assert np.abs(found.q[-1] - found.q[0]).max() < 1e-6
    assert np.abs(run(square(clause)).q[-1] - found.q[0]).max() > 1e-3


def test_a_joint_may_be_frozen_for_it(run) -> None:
    found = run(f"FREEZESTART 4;\n{square(TURN)}FREEZEEND;\n")
    assert np.unique(found.q[:, 3]).size == 1
    assert np.ptp(run(square(TURN)).q[:, 3]) > 0.01


@pytest.mark.req("LANG-63")
def test_not_for_a_move_without_it(run) -> None:
    with pytest.raises(irlx.RunError) as refused:
        run(f"FREEZESTART 4;\n{square(TURN)}MOVE_INC LIN (0, 10, 0);\nFREEZEEND;\n")
    assert refused.value.reason.code == "IRL347"
    assert refused.value.reason.place.line == 4
    with pytest.raises(irlx.RunError, match=r"2 joints are frozen, but .* can spare 1"):
        run(f"FREEZESTART 4, 5;\n{square(TURN)}FREEZEEND;\n")


def test_a_move_behind_leads_back_exactly(run) -> None:
    body = "MOVE_INC LIN (0, 150, 0) WITH TOLERANCE (0, 0, 0, 9, 9, 9);\nMOVE LIN home;\n"
    found = run(f"home := R_ROBTARGET_ACT;\n{body}")
    position, rotation = tool(run, found)
    before = np.flatnonzero(found.block == 1)[-1]
    assert Rotation.from_matrix(rotation[0].T @ rotation[before]).magnitude() > 0.01
    assert Rotation.from_matrix(rotation[0].T @ rotation[-1]).magnitude() < BAND
    assert np.linalg.norm(position[-1] - position[0]) < BAND


def test_bands_do_not_add_up_from_move_to_move(run) -> None:
    clause = "WITH TOLERANCE (0, 0, 2, 0, 0, 0)"
    body = "".join(f"  MOVE_INC LIN (0, {10 if k % 2 else -30}, 0) {clause};\n" for k in range(8))
    found = run(body)
    position, rotation = tool(run, found)
    # Way along y and depth along the tool's axis that lead to where the tool is.
    axes = np.stack([np.array([0.0, 1.0, 0.0]), rotation[0][:, 2]], axis=1)
    (_, depth), *_ = np.linalg.lstsq(axes, (position - position[0]).T)
    assert np.abs(depth).max() <= 0.002 + BAND


@pytest.mark.parametrize(
    "body",
    [
        f"MOVE_INC CIRCLE (0, 75, -75), (0, 150, 0) {TURN};\n",
        "MOVE_INC CIRCLE (0, 75, -75), (0, 150, 0) ANGLE := 360 WITH TOLERANCE (0, 0, 2, 3, 3, 0);\n",
        f"MOVE_INC LIN PATH ((0, 100, 0), (0, 0, -100), (0, -100, 0)) C_CP := 20 {TURN};\n",
        f"MOVE_INC SPLINE PATH ((0, 100, 0), (0, 0, -100), (0, -100, 0)) {TURN};\n",
        f"MOVE_INC LIN POSE(POSITION(0, 0, 0), ORIZYX(0, 20, 0)) {TURN};\n",
        f"MOVE LIN (12, 27, 18, 15, 40, 0) {TURN};\n",
        f"MOVE_INC LIN (0, 100, 0) WITH RECONFIGURATION (12, 27, 12, 40, 50, 10) {TURN};\n",
        f"MOVE PTP POSE(R_ROBTARGET_ACT.pse.pos + POSITION(0, 100, 0), R_ROBTARGET_ACT.pse.ori) {TURN};\n"
        f"MOVE_INC LIN (0, -50, 0) {TURN};\n",
        f"CRITERION JOINT_CENTRING;\nCRITERION KINETIC_ENERGY;\n{square(TURN)}"
        "CRITERIONEND KINETIC_ENERGY;\nCRITERIONEND JOINT_CENTRING;\n",
        f"JOINTSPEEDLIMIT (-15, -15, -15, -15, -15, -15), (15, 15, 15, 15, 15, 15);\n"
        f"MOVE_INC LIN (0, 100, 0) {TURN};\nJOINTSPEEDLIMITEND;\n",
        f"MOVE_INC LIN (0, 100, 0) C_CP := 20 {TURN};\nMOVE_INC LIN (0, 0, -50);\n",
        f"R_TOOL := (POSITION(0, 30, 50), ORIZYX(0, 20, 0));\n{square(TURN)}",
    ],
)
def test_moves_and_options_of_every_kind_verify(run, body: str) -> None:
    found = run(body)
    assert found.complete
    assert len(found.q) > 10


def test_a_ptp_takes_a_posture_within_the_bands(run) -> None:
    target = "POSE(R_ROBTARGET_ACT.pse.pos + POSITION(0, 150, 0), R_ROBTARGET_ACT.pse.ori)"
    exact, free = run(f"MOVE PTP {target};\n"), run(f"MOVE PTP {target} {TURN};\n")
    for found in (exact, free):
        position, rotation = tool(run, found)
        assert np.allclose(position[-1] - position[0], [0, 0.15, 0], atol=1e-7)
        assert np.allclose(rotation[-1][:, 2], rotation[0][:, 2], atol=1e-7)
    weights = np.arange(6.0, 0.0, -1.0)
    ways = [float(weights @ (found.q[-1] - found.q[0]) ** 2) for found in (exact, free)]
    assert ways[1] < 0.95 * ways[0]


def test_an_explained_tick_names_the_virtual_joint(tmp_path) -> None:
    (tmp_path / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n{square(TURN)}ENDPROGRAM\n")
    (tmp_path / "p.toml").write_text(CELL)
    found = irlx.run(tmp_path / "p.irl", explain_tick=20)
    assert "TOLERANCE dc" in str(found.explanation.to_plain())


def test_what_closes_the_way_names_the_band(run) -> None:
    with pytest.raises(irlx.RunError, match=r"IRL52[0-4].*TOLERANCE db|TOLERANCE da"):
        run(f"FREEZESTART 4;\n{square('WITH TOLERANCE (0, 0, 0, 3, 3, 0)')}FREEZEEND;\n")


@pytest.mark.req("STR-06")
def test_a_cycle_that_begins_off_the_programmed_pose(run) -> None:
    """A move without bands to the pose off which the tool stood then is no return to that posture."""
    there = "home.PSE + POSITION(0, 100, 0)"
    away = f"home := R_ROBTARGET_ACT;\nMOVE LIN {there} WITH TOLERANCE (0, 0, 0, 5, 5, 0);\n"
    # Verified by the fixture.
    found = run(f"{away}CYCLICSTART;\nMOVE PTP {there};\nCYCLICEND;\n")
    began = found.stream.records[1].tick
    assert np.abs(found.q[-1] - found.q[began]).max() > 1e-3


FREE = {
    "one": 'task = ["x", "y", "z", "rx", "ry"]\nfree = ["rz"]',
    "all": 'task = ["x", "y", "z"]\nfree = ["rx", "ry", "rz"]',
}


def free_cell(kind: str) -> str:
    return f'[robot]\nmodel = "arm7"\n{FREE[kind]}\n[motion]\ntick_ms = 20\n'


@pytest.mark.parametrize("kind", FREE)
def test_bands_lie_along_the_programmed_pose_however_the_tool_turns_freely(run, kind: str) -> None:
    """A line to the side with 4 mm along x of the pose that the start has: nothing is left in y and z."""
    found = run("MOVE_INC LIN POSITION(0, 80, 0) WITH TOLERANCE (4, 0, 0, 0, 0, 0);\n", free_cell(kind))
    position, rotation = tool(run, found)
    assert np.degrees(Rotation.from_matrix(rotation[0].T @ rotation[-1]).magnitude()) > 0.3
    off = (position - position[0]) @ rotation[0]
    along, aside = rotation[0].T @ [0.0, 1.0, 0.0], np.array([1.0, 0.0, 0.0])
    left = off @ np.cross(along, aside)
    assert np.abs(left).max() < 1e-8
    assert np.abs(off[-1] - 0.08 * along)[1:].max() < 1e-8


@pytest.mark.parametrize("bands", first(1, [(0, 3, 0, 5, 5, 0), (0, 0, 2, 0, 5, 0), (0, 0, 0, 5, 0, 0)]))
def test_bands_beside_a_turn_that_follows(run, bands: tuple[int, ...]) -> None:
    cell = '[robot]\nmodel = "irb6"\nstart = [-8, -5, 4, 25, -12]\n[motion]\ntick_ms = 20\n'
    way, back = (
        f"  MOVE_INC LIN {side} WITH TOLERANCE {bands};\n" for side in ((27, -18, -13), (-27, 18, 13))
    )
    # Verified by the fixture.
    found = run(f"  CYCLICSTART;\n{way}{back}  CYCLICEND;\n", cell)
    assert travel(found) > 10.0


@pytest.mark.parametrize("kind", FREE)
def test_a_move_behind_bands_of_turns_begins_where_the_tool_stands(run, kind: str) -> None:
    turned = "MOVE_INC LIN POSE(POSITION(0, 40, 0), ORIXYZ(10, 0, 0)) WITH TOLERANCE (0, 0, 0, 0, 2, 0);\n"
    found = run(turned + "MOVE_INC LIN POSITION(0, 40, 0);\n", free_cell(kind))
    assert found.complete
    assert found.summary.moves == 2


def narrower(stream: JointStream, part: int) -> JointStream:
    """A stream whose moves were asked for nine tenths of a band."""

    def changed(record: BlockRecord) -> BlockRecord:
        clause = record.block.tolerance
        bands = tuple(band * (0.9 if number == part else 1.0) for number, band in enumerate(clause.bands))
        return replace(record, block=replace(record.block, tolerance=replace(clause, bands=bands)))

    return replace(stream, records=tuple(changed(record) for record in stream.records))


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    ("bands", "part"),
    first_rows(2, [((0, 0, 0, 0, 3, 0), 4), ((0, 0, 2, 0, 0, 0), 2), ((0, 2, 0, 1, 1, 1), 5)]),
)
def test_the_verifier_finds_a_band_passed(run, tmp_path, bands: tuple[int, ...], part: int) -> None:
    found = run(square(f"WITH TOLERANCE {bands}"))
    found.save(tmp_path / "p.npz")
    stream = read_stream(tmp_path / "p.npz")
    assert verify_stream(stream, run.robot()).passed
    report = verify_stream(narrower(stream, part), run.robot())
    assert "tolerance bands" in {check.name for check in report.failed}


def test_the_verifier_finds_the_place_on_several_rounds(run) -> None:
    """Beside two rounds of 10 mm the bands leave a place between two narrow hollows."""
    cell = CELL.replace("locked = { rail_joint = 150 }\nstart = [8", "start = [0, 8")
    cell = cell.replace("[robot.limits]\nacceleration = [400, 400, 500, 900, 900, 1200]\n", "")
    ends = f"{HERE} + POSITION(0, 10, 10), {HERE} + POSITION(0, 20, 0)"
    # Verified by the fixture.
    run(f"MOVE CIRCLE {ends} ANGLE := 720 WITH TOLERANCE (1, 1, 1, 0, 0, 0);\n", cell)


def still(q: np.ndarray) -> np.ndarray:
    """Rows of a robot that stays where it is."""
    return np.repeat(q[:1], len(q), axis=0)


def to_and_fro(q: np.ndarray) -> np.ndarray:
    """Rows of a robot that turns back on its way, and again."""
    rows = len(q)
    corners = [0, rows // 3, 2 * rows // 3, rows - 1]
    way = np.interp(np.arange(rows), corners, [0, 2 * rows // 3, rows // 3, rows - 1])
    return q[np.rint(way).astype(int)]


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    ("body", "change", "bands"),
    chequered(
        [
            pytest.param(f"MOVE CIRCLE {ROUND} ANGLE := 360", still, id="still"),
            pytest.param("MOVE_INC LIN (0, 150, 0)", to_and_fro, id="to and fro"),
        ],
        [(0, 0, 2, 0, 0, 0), (3, 0, 2, 1, 1, 1)],
    ),
)
def test_the_verifier_finds_a_way_not_run(run, tmp_path, body, change, bands) -> None:
    """A tool beside its path tells of the place on it up to what the bands leave open."""
    found = run(f"  {body} WITH TOLERANCE {bands};\n")
    found.save(tmp_path / "p.npz")
    stream = read_stream(tmp_path / "p.npz")
    q = change(stream.q)
    position, rotation = forward(run.robot(), q)
    tool = np.hstack([position, Rotation.from_matrix(rotation).as_quat()])
    pretended = replace(stream, q=q, tool=tool)
    report = verify_stream(pretended, run.robot())
    assert "path progress" in {check.name for check in report.failed}, str(report)


@pytest.mark.parametrize("name", ["free_turn", "free_turn_fixed"])
def test_the_programs_run_without_a_word_and_verify(name: str) -> None:
    program, cell = FOLDER / f"{name}.irl", FOLDER / "free_turn.toml"
    found = irlx.run(program, cell=cell)
    assert [str(told) for told in found.diagnostics] == []
    assert found.summary.moves >= 10
    assert irlx.verify(found, program=program, cell=cell).passed


@pytest.mark.parametrize("seed", [15, pytest.param(range(1, 60), marks=pytest.mark.slow)])
def test_drawn_programs_verify(seed, tmp_path) -> None:
    for number in [seed] if isinstance(seed, int) else seed:
        print("seed", number)
        rng = np.random.default_rng(number)
        (tmp_path / "p.toml").write_text(CELL)
        (tmp_path / "p.irl").write_text(drawn(rng))
        found, code = carried_out(tmp_path / "p.irl")
        # Paths may lead out of reach, bands may close a way: told by these codes alone.
        assert code in {"", "IRL520", "IRL521", "IRL523", "IRL524", "IRL423"}
        report = irlx.verify(found, cell=tmp_path / "p.toml")
        assert {check.name for check in report.failed} <= {"complete"}, str(report)


def carried_out(program: Path) -> tuple[irlx.Run, str]:
    """What a program comes to, and the code of what ended it."""
    try:
        return irlx.run(program), ""
    except irlx.RunError as error:
        return error.run, error.reason.code


def drawn(rng: np.random.Generator) -> str:
    """A program of a few moves with bands of all sizes, zeros and free turns among them."""
    lines = []
    for _ in range(5):
        bands = [rng.choice([0.0, 0.0, 1e-6, 0.5, 2.0]) for _ in range(3)]
        bands += [rng.choice([0.0, 0.0, 1e-6, 1.0, 10.0, 90.0, 360.0]) for _ in range(3)]
        clause = f"WITH TOLERANCE ({', '.join(map(repr, map(float, bands)))})"
        clause = clause if rng.random() < 0.8 else ""
        x, y, z = (float(rng.choice([0.0, rng.uniform(-60, 60)])) for _ in range(3))
        turn = ", ".join(repr(float(angle)) for angle in rng.uniform(-15, 15, 3))
        kind = rng.integers(3)
        if kind == 0:
            lines.append(f"MOVE_INC LIN ({x!r}, {y!r}, {z!r}) {clause};")
        elif kind == 1:
            lines.append(f"MOVE_INC LIN POSE(POSITION({x!r}, {y!r}, {z!r}), ORIZYX({turn})) {clause};")
        else:
            lines.append(f"MOVE_INC CIRCLE (20, {y!r}, 30), ({x!r}, 40, {z!r}) {clause};")
    options = rng.choice(
        ["", "CYCLICSTART;", "JOINTSPEEDLIMIT (-9, -9, -9, -9, -9, -9), (9, 9, 9, 9, 9, 9);"]
    )
    end = {"": "", "CYCLICSTART;": "CYCLICEND;"}.get(str(options), "JOINTSPEEDLIMITEND;")
    return "\n".join(["PROGRAM p;", "BEGIN", str(options), *lines, end, "ENDPROGRAM", ""])
