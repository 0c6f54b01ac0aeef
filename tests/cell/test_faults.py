"""Everything that can be wrong with a cell file: code, key path, message."""

import pytest

from irlx.cell.errors import CellError
from irlx.cell.find import find_cell
from irlx.cell.load import load_cell
from irlx.diagnostics import Place

ENTRY = "a number, a pair [lower, upper], or false"
LIMIT = f"{ENTRY}, for each joint"


@pytest.fixture
def of_a_part(faults):
    """Faults of a text that names no robot, without that one."""
    return lambda text: [one for one in faults(text) if one[0] != "IRL610"]


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("text", "cause"),
    [
        (b"[robot\n", "line 1, column 7"),
        (b"a = 1\na = 2\n", "line 2"),
        (b"a = \n", "line 1"),
        (b"\xff\xfe", "byte 0 is no UTF-8"),
        (b"# \xe9\n", "byte 2 is no UTF-8"),
        (b"a = " + b"1" * 5000, "digits"),
        # How deep is too deep, and in which words, is the TOML reader's own matter.
        (b"a = " + b"[" * 5000, ""),
    ],
)
def test_not_toml(faults, text, cause):
    ((code, key, message),) = faults(text)
    assert (code, key) == ("IRL601", "")
    assert message.startswith("the cell file is not TOML: ")
    assert cause in message


def test_a_byte_order_mark_is_no_fault(cell, koch):
    assert cell(b"\xef\xbb\xbf" + koch.encode()).model == "koch11"


@pytest.mark.req("CELL-02")
@pytest.mark.parametrize(
    ("text", "key", "near", "known"),
    [
        (
            "[robt]\n",
            "robt",
            "; did you mean 'robot'?",
            "robot, motion, frames, constraint, obstacle",
        ),
        (
            "[robot]\nmodl = 1\n",
            "robot.modl",
            "; did you mean 'model'?",
            "model, tip, locked, origins, task, task_frame, free, start",
        ),
        ("[robot.limits]\nspeeed = 1\n", "robot.limits.speeed", "; did you mean 'speed'?", "position, speed"),
        ("[robot.limits]\njerk = 1\n", "robot.limits.jerk", "", "position, speed, acceleration"),
        ("[motion]\ntick = 3\n", "motion.tick", "; did you mean 'tick_ms'?", "tick_ms, speed, acc"),
        ("[frames]\nf = { rpi = 1 }\n", "frames.f.rpi", "; did you mean 'rpy'?", "xyz, rpy"),
    ],
)
def test_unknown_keys(cell, text, key, near, known):
    with pytest.raises(CellError) as caught:
        cell(text)
    found, *others = caught.value.diagnostics
    assert {one.code for one in others} <= {"IRL610"}
    assert (found.code, found.place.key) == ("IRL602", key)
    assert found.message == f"no such key: {key}{near}"
    assert found.help.startswith(f"keys known here: {known}")


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("text", "key", "expected", "found"),
    [
        ("[robot]\nmodel = 5\n", "robot.model", "a text", "5"),
        ("[robot]\nweights = [1, 0]\n", "robot.weights[2]", "a number greater than 0", "0"),
        ("[robot]\nweights = [inf]\n", "robot.weights[1]", "a finite number", "inf"),
        ("[robot]\nstart = [1, nan]\n", "robot.start[2]", "a finite number", "nan"),
        ("[robot]\nstatus_joints = [1]\n", "robot.status_joints[1]", "a text", "1"),
        ("[motion]\ntick_ms = 0.1\n", "motion.tick_ms", "a number of at least 0.25", "0.1"),
        ("[motion]\ntick_ms = 1000.5\n", "motion.tick_ms", "a number of at most 1000", "1000.5"),
        ("[motion]\nspeed = -1\n", "motion.speed", "a number greater than 0", "-1"),
        ("[motion]\nspeed = 'fast'\n", "motion.speed", "a number", "'fast'"),
        ("[motion]\nacc = true\n", "motion.acc", "a number", "true"),
        ("[motion]\nacc_ptp = 101\n", "motion.acc_ptp", "a number of at most 100", "101"),
        ("[robot.limits]\nspeed = 5\n", "robot.limits.speed", LIMIT, "5"),
        ("[robot.limits]\nspeed = true\n", "robot.limits.speed", LIMIT, "true"),
        ("[robot.limits]\nspeed = 0\n", "robot.limits.speed", LIMIT, "0"),
        ("[robot.limits]\nspeed = [1, {}]\n", "robot.limits.speed[2]", ENTRY, "a table"),
        ("[robot]\nlocked = { j = '1' }\n", "robot.locked.j", "a number", "'1'"),
        ("[robot]\nweights = [true]\n", "robot.weights[1]", "a number", "true"),
        ("[frames]\nf = { xyz = [1, 2] }\n", "frames.f.xyz", "three numbers", "[1, 2]"),
        ("[frames]\nf = { rpy = [1, 2, true] }\n", "frames.f.rpy[3]", "a number", "true"),
        (
            "[frames]\nR_TOOL = {}\n",
            "frames.R_TOOL",
            "another name, for this one is a system variable",
            "a table",
        ),
        ("[robot.limits]\nspeed = 'a'\n", "robot.limits.speed", LIMIT, "'a'"),
        ("[motion]\nc_pass = 1\n", "motion.c_pass", "true or false", "1"),
        ("[motion]\nprofile = 'S'\n", "motion.profile", "'TRAPEZOID' or 'S_CURVE'", "'S'"),
        ("[robot]\ntask = []\n", "robot.task", "one entry at least", "[]"),
        ("[[constraint]]\nname = ''\n", "constraint[1].name", "a text that is not empty", "''"),
    ],
)
def test_values(of_a_part, text, key, expected, found):
    assert of_a_part(text) == [("IRL603", key, f"{key}: expected {expected}, found {found}")]


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("table", "value"), [("frames", "{ xyz = [1, 2, 3] }"), ("signals.inputs", "[[0, 1]]")]
)
def test_names_that_differ_in_case_alone(faults, table, value):
    key = f"{table}.part"
    text = f"[robot]\nmodel = 'koch11'\n[{table}]\nPart = {value}\npart = {value}\n"
    expected = f"{key}: expected a name that differs from 'Part' in more than case, found 'part'"
    assert faults(text) == [("IRL603", key, expected)]


@pytest.mark.req("CELL-01")
def test_whole_numbers_beyond_all_others(of_a_part):
    ((code, key, message),) = of_a_part(f"[signals.inputs]\nIN_1 = [[0, 1{'0' * 400}]]\n")
    assert (code, key) == ("IRL603", "signals.inputs.IN_1")
    assert "a list of pairs [time in s, value], true or false or a number, found [[0, 1000" in message


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize("section", ["robot", "motion", "frames", "frames.f", "robot.locked", "robot.limits"])
def test_sections_are_tables(of_a_part, section):
    ((code, key, message),) = of_a_part(f"{section} = 3\n")
    assert (code, key) == ("IRL603", section)
    assert message.endswith("found 3")


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize("text", ["robot = 3\n", "[frames]\nf = 3\n", "[frames]\nf = { xyz = [1, 2] }\n"])
def test_messages_speak_of_the_file(of_a_part, text):
    ((_, _, message),) = of_a_part(text)
    assert "instance of" not in message
    assert "validation" not in message


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize("entry", ["true", "'a'", "[1, 2, 3]", "inf", "[1, 'b']"])
def test_the_entry_of_a_limit_is_named(of_a_part, entry):
    ((code, key, _),) = of_a_part(f"[robot.limits]\nspeed = [1, {entry}, 3]\n")
    assert (code, key) == ("IRL603", "robot.limits.speed[2]")


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize("entry", ["'5'", "true"])
def test_texts_are_no_numbers(faults, entry):
    ((code, key, _),) = faults(
        f"[robot]\nmodel = 'koch11'\nstart = [{entry}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n"
    )
    assert (code, key) == ("IRL603", "robot.start[1]")


@pytest.mark.req("CELL-01")
def test_one_value_a_joint(faults, koch):
    text = koch + "start = [1, 2]\nweights = [1]\n[robot.limits]\nposition = [[1, 2]]\nspeed = [1, 2]\n"
    expected = {"robot.limits.position": 1, "robot.limits.speed": 2, "robot.start": 2, "robot.weights": 1}
    assert faults(text) == [
        ("IRL604", key, f"{key} needs one value a joint: 11, found {count}")
        for key, count in expected.items()
    ]


@pytest.mark.req("CELL-01")
def test_limits_that_are_no_range(faults, koch):
    position = "[180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [0, -180], 180, 60, 180, 500, 60]"
    speed = "[[1, 2], -5, 1, 1, 1, 1, 1, 1, 1, 1, [-2, -1]]"
    text = koch + f"[robot.limits]\nposition = {position}\nspeed = {speed}\n"
    above, standstill = "the lower bound is above the upper one", "the range does not contain standstill (0)"
    assert faults(text) == [
        (
            "IRL605",
            "robot.limits.position[6]",
            f"the position limit of joint_6 is no range: {above} (found [0, -180])",
        ),
        (
            "IRL605",
            "robot.limits.speed[1]",
            f"the speed limit of joint_1 is no range: {standstill} (found [1, 2])",
        ),
        (
            "IRL605",
            "robot.limits.speed[2]",
            "the speed limit of joint_2 is no range: a single limit must not be negative (found -5)",
        ),
        (
            "IRL605",
            "robot.limits.speed[11]",
            f"the speed limit of joint_11 is no range: {standstill} (found [-2, -1])",
        ),
    ]


def test_status_joints(faults, koch):
    key = "robot.status_joints[2]"
    message = f"{key}: the robot has no joint 'jont_3'; did you mean 'joint_3'"
    ((code, found, words),) = faults(koch + 'status_joints = ["joint_1", "jont_3"]\n')
    assert (code, found) == ("IRL606", key)
    assert words.startswith(message)


@pytest.mark.req("CELL-01")
def test_all_faults_at_once(faults):
    text = """[robot]
modl = "koch11"
weights = [1, 0]
[motion]
speed = -1
tick = 3
[frames]
f = { rpi = [0, 0, 0] }
[colour]
"""
    keys = {key for _, key, _ in faults(text)}
    expected = {"robot.modl", "robot.weights[2]", "motion.speed", "motion.tick", "frames.f.rpi", "colour"}
    assert keys == expected


@pytest.mark.req("CELL-01")
def test_start_outside_the_limits(faults, koch):
    limits = "position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, 60]"
    start = "start = [0, 10, -102, 146, -80, -8, 55, 24, 106, -2000, 58]"
    text = f"{koch}{start}\n[robot.limits]\n{limits}\n"
    assert faults(text) == [
        ("IRL620", "robot.start[2]", "joint_2 starts at 10 deg, outside its limits -150 to 0 deg"),
        ("IRL620", "robot.start[10]", "joint_10 starts at -2000 mm, outside its limits -500 to 500 mm"),
    ]


@pytest.mark.req("CELL-03")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the cell names no robot"),
        ("[robot]\n", "the cell names no robot"),
        ("[robot]\nmodel = 'koch1'\n", "no robot 'koch1'; did you mean 'koch11'?"),
        ("[robot]\nmodel = 'something'\n", "no robot 'something'"),
    ],
)
def test_no_robot(faults, text, message):
    ((code, key, found),) = faults(text)
    assert (code, key) == ("IRL611" if "model" in text else "IRL610", "robot.model")
    assert found == message


@pytest.mark.req("CELL-03")
@pytest.mark.parametrize("model", ["kr1o.urdf", "./kr1o.urdf", "kr1o"])
def test_a_urdf_with_a_name_like_that_is_named(faults, tmp_path, model):
    (tmp_path / "kr10.urdf").write_text("", encoding="utf-8")
    ((code, _, message),) = faults(f"[robot]\nmodel = '{model}'\n")
    assert code == "IRL611"
    assert message.endswith("; did you mean 'kr10.urdf'?")


@pytest.mark.req("CELL-03")
@pytest.mark.parametrize("model", ["no.urdf", "./no.urdf", "sub/no.urdf", "."])
def test_a_missing_urdf_says_where_it_was_looked_for(faults, tmp_path, model):
    ((code, key, message),) = faults(f"[robot]\nmodel = '{model}'\n")
    assert (code, key) == ("IRL611", "robot.model")
    assert message == f"no robot '{model}' (looked for {tmp_path / model})"


@pytest.mark.parametrize(
    ("robot", "words"),
    [
        ("tip = 'tpc'", "no link is called 'tpc'; did you mean 'tcp'?"),
        ("locked = { jont_1 = 3 }", "no joint is called 'jont_1'; did you mean 'joint_1'"),
    ],
)
def test_names_that_the_model_lacks(faults, koch, robot, words):
    ((code, _, message),) = faults(koch + robot + "\n")
    assert code == "IRL612"
    assert message.startswith(f"the robot model koch11 cannot be used: {words}")


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("robot", "key"), [("tip = 'tpc'", "robot.tip"), ("locked = { x = 3 }", "robot.locked.x")]
)
def test_names_that_the_model_lacks_are_told_at_their_key(faults, koch, robot, key):
    ((_, found, _),) = faults(koch + robot + "\n")
    assert found == key


@pytest.mark.parametrize(
    ("content", "cause"),
    [
        ("<robot", "it is not well-formed XML"),
        ("<sdf/>", "its outermost element is <sdf>, a URDF has <robot>"),
        ("<robot/>", "it has no <link>"),
    ],
)
def test_a_urdf_that_cannot_be_used(faults, content, cause):
    ((code, key, message),) = faults("[robot]\nmodel = 'bad.urdf'\n", bad=content)
    assert (code, key) == ("IRL612", "robot.model")
    assert message.startswith(f"the robot model bad.urdf cannot be used: {cause}")


def test_fewer_than_six_axes(faults, chain):
    expected = (
        "the joints that move the tool frame link4 are j1, j2, j3, j4: 4, but the task has 6 coordinates"
    )
    assert faults("[robot]\nmodel = 'c.urdf'\n", c=chain(4)) == [("IRL613", "robot.model", expected)]


@pytest.mark.req("CELL-03")
def test_files_that_cannot_be_read(tmp_path):
    for path, code in [(tmp_path / "no.toml", "IRL001"), (tmp_path, "IRL007")]:
        with pytest.raises(CellError) as caught:
            load_cell(path)
        assert caught.value.reason.code == code
        assert str(path) in caught.value.reason.message
    (tmp_path / "now.toml").touch()
    with pytest.raises(CellError, match=r"no such file: .*; did you mean 'now\.toml'\?"):
        load_cell(tmp_path / "no.toml")


@pytest.mark.req("CELL-03")
def test_no_cell_file_found(tmp_path):
    tried = [tmp_path / "a.toml", tmp_path / "b.toml"]
    with pytest.raises(CellError) as caught:
        find_cell(tried, Place("p.irl"))
    message = f"no cell file found; tried {tried[0]}, {tried[1]}"
    assert (caught.value.reason.code, caught.value.reason.message) == ("IRL609", message)
    tried[1].touch()
    assert find_cell(tried, None) == tried[1]


WRONG = """[robot]
{model}
start = [0, 0, 0, 0]
[robot.limits]
position = [[170, -170], 120, 170, 150, 170, 120, 170]
speed = [100, 100]
acceleration = 100
[motion]
tick = 10
[frames]
table = { xyz = [600, 0] }
[[obstacle]]
name = "wall"
shape = "box"
size = [400, 20]
frame = "table"
margin = 50
influence = 20
[[obstacle]]
name = "post"
shape = "cube"
"""
OF_SCHEMA = {
    ("IRL603", "robot.limits.acceleration"),
    ("IRL602", "motion.tick"),
    ("IRL603", "frames.table.xyz"),
    ("IRL603", "obstacle[1].size"),
}
OF_OBSTACLES = {("IRL633", "obstacle[1].margin"), ("IRL630", "obstacle[2].shape")}


@pytest.mark.req("CELL-01")
def test_what_a_key_may_hold_and_what_the_robot_says_is_told_at_once(faults):
    """The box lacks no size, which is at fault; a start that is no posture is held against no limits."""
    found = faults(WRONG.replace("{model}", 'model = "arm7"'))
    of_robot = {
        ("IRL605", "robot.limits.position[1]"),
        ("IRL604", "robot.limits.speed"),
        ("IRL604", "robot.start"),
    }
    assert len(found) == len({(code, key) for code, key, _ in found})
    assert {(code, key) for code, key, _ in found} == OF_SCHEMA | of_robot | OF_OBSTACLES


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("model", "more"),
    [
        ('model = "arm8"', {("IRL611", "robot.model")}),
        # The model that is missing is the one with a slip in its key.
        ('modell = "arm7"', {("IRL602", "robot.modell")}),
        ('model = "arm8"\nmodell = "arm7"', {("IRL611", "robot.model"), ("IRL602", "robot.modell")}),
        # The joints would be others.
        ('model = "arm7"\ntip = 3', {("IRL603", "robot.tip")}),
    ],
)
def test_without_a_robot_all_else_is_told(faults, model, more):
    found = {(code, key) for code, key, _ in faults(WRONG.replace("{model}", model))}
    assert found == OF_SCHEMA | more | OF_OBSTACLES
