"""What the command line says of obstacles that come too near."""

import re

import pytest

CELL = """[robot]
model = "arm7"
[motion]
tick_ms = 20
[[obstacle]]
name = "thing"
"""
BALL = 'shape = "sphere"\nradius = 60\n'
# The tool of the start posture points down at (441, 261, 325) mm, the elbow is at (149, 125, 660).
NEAR_THE_TOOL = 'shape = "box"\nsize = [100, 100, 100]\n'


@pytest.fixture
def said(folder, inside):
    """What `irlx run` says of a body with `OBSTACLE thing` around it: exit code and stderr."""

    def run(body, obstacle, declarations="", margin=20):
        (folder / "p.toml").write_text(f"{CELL}{obstacle}margin = {margin}\n", encoding="utf-8")
        lines = [
            f"PROGRAM p; {declarations}",
            "BEGIN",
            "  OBSTACLE thing;",
            f"  {body}",
            "  OBSTACLEEND thing;",
        ]
        (folder / "p.irl").write_text("\n".join([*lines, "ENDPROGRAM", ""]), encoding="utf-8")
        done = inside("run", "p.irl")
        return done.returncode, done.stderr

    return run


@pytest.mark.req("TRF-13")
def test_start_in_a_collision_names_the_pair_and_how_deep(said):
    # The flange ends at the tool, at z = 325 mm; the lid of the box is 25 mm above that.
    code, err = said("MOVE LIN POSITION(441, 261, 400);", NEAR_THE_TOOL + "xyz = [441, 261, 300]\n")
    assert code == 1
    assert "p.irl:3:3: error IRL562: link 'flange' and obstacle 'thing' overlap by" in err
    depth = float(re.search(r"overlap by ([0-9.]+) mm", err)[1])
    assert 20.0 < depth < 35.0


@pytest.mark.req("TRF-13")
def test_start_inside_the_margin_is_a_warning(said):
    code, err = said(
        "MOVE LIN POSITION(441, 261, 400);", NEAR_THE_TOOL + "xyz = [441, 261, 250]\n", margin=40
    )
    assert code == 0
    assert "p.irl:3:3: warning IRL563: link 'flange' and obstacle 'thing' are 22.83 mm apart" in err
    assert "inside the margin of 40 mm" in err


@pytest.mark.req("TRF-13")
def test_ptp_through_an_obstacle(said):
    code, err = said("MOVE PTP POSITION(441, -240, 325);", BALL + "xyz = [500, 60, 325]\n")
    assert code == 1
    assert "p.irl:4:3: error IRL561: MOVE PTP comes too near: at tick " in err
    found = re.search(r"link 'flange' and obstacle 'thing' are ([0-9.]+) mm apart, 20 mm are kept", err)
    assert 0.0 < float(found[1]) < 20.0
    # What helps is told, too.
    assert "targets on the way" in err


@pytest.mark.req("TRF-13")
def test_line_through_an_obstacle_names_pair_distance_and_place(said):
    code, err = said("MOVE LIN POSITION(441, -40, 325);", BALL + "xyz = [441, 60, 325]\n")
    assert code == 1
    found = re.search(
        r"p\.irl:4:3: error IRL560: the tool cannot go beyond ([0-9.]+) of 300\.964 mm \(tick \d+\) at any"
        r" speed and keep clear: link 'flange' and obstacle 'thing' would be ([0-9.]+) mm apart,"
        r" 20 mm are kept",
        err,
    )
    place, distance = float(found[1]), float(found[2])
    # By then the flange has come to within 80 mm of the middle of the ball, 201 mm away at first.
    assert 60.0 < place < 121.0
    # The next place that was tried is past the margin, and not by far.
    assert 18.0 < distance < 20.0


@pytest.mark.req("TRF-13")
def test_reconfiguration_into_an_obstacle(said):
    code, err = said(
        "RECONFIGURATION far;",
        BALL + "xyz = [100, -40, 700]\n",
        "VAR MAIN_JOINT: far := (-40, 29, 100, 95, 9, 48, -13);",
    )
    assert code == 1
    assert "p.irl:4:3: error IRL561: RECONFIGURATION comes too near: at tick " in err
    assert "and obstacle 'thing' are " in err


@pytest.mark.req("TRF-13")
def test_line_that_ends_just_clear_of_a_wall_is_done(said):
    # Straight at the wall, and to rest half a millimetre before its margin.
    wall = 'shape = "box"\nsize = [300, 20, 40]\nxyz = [441, 58, 300]\n'
    code, err = said("MOVE LIN POSITION(441, 100, 325);", wall)
    assert (code, err) == (0, "")
