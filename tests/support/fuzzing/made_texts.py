"""Programs with modules, data lists and cells beside them, of which the project has few that are small."""

_PROGRAM = "PROGRAM p;\n{above}VAR INT: n; POSE: q;\nBEGIN\n{body}\nENDPROGRAM\n"
_MODULE = """MODULE tools;
{above}EXPORT twice, step, place, BOX;
TYPE RECORD REAL: w, h; ENDRECORD = BOX;
CONST REAL: step := 5;
VAR POSE: place; INT: hidden;
PROCEDURE twice(VAR INT: k); BEGIN k := k * 2; ENDPROC;
FUNCTION half(REAL: x): REAL; BEGIN RETURN x / 2; ENDFCT;
ENDMODULE
"""
_LIST = """DATALIST points;
  POSE: p0 := ((600, 0, 400), ORIZYX(0, 180, 0)), p1 := p0;
  INT: count := 3;
ENDDATALIST
"""
_FRAMES = """[robot]
model = "{model}"
[frames]
pipe = {{ link = "{link}", xyz = [0, 80, 0] }}
plate = {{ xyz = [1, 2, 3] }}
"""
_WALL = '[[obstacle]]\nname = "wall"\nshape = "box"\nsize = [20, 1000, 150]\nxyz = [2880, 0, 75]\n'
_IMPORT = "FROM tools IMPORT twice, step, place, BOX;\n"


def _program(body: str, above: str = "") -> str:
    return _PROGRAM.format(above=above, body=body)


def _module(above: str = "") -> str:
    return _MODULE.format(above=above)


MADE: tuple[dict[str, str], ...] = (
    {"": _program("  twice(n); MOVE LIN place SPEED := step;", _IMPORT), "tools.irl": _module()},
    {"": _program("  q := p0 @ p1; n := count;", "IMPORT DATALIST points;\n"), "points.dat": _LIST},
    {
        "": _program("  twice(n);", _IMPORT),
        "tools.irl": _module("FROM more IMPORT one;\nIMPORT DATALIST points;\n"),
        "more.irl": "MODULE more;\nEXPORT one;\nCONST INT: one := 1;\nENDMODULE\n",
        "points.dat": _LIST,
    },
    {
        "": _program("  n := one;", "FROM more IMPORT one;\n"),
        "more.irl": "MODULE more;\nFROM less IMPORT two;\nEXPORT one;\nCONST INT: one := 1;\nENDMODULE\n",
        "less.irl": "MODULE less;\nFROM more IMPORT one;\nEXPORT two;\nCONST INT: two := 2;\nENDMODULE\n",
    },
    {"": _program("  n := half(1);", "FROM tools IMPORT half;\n"), "tools.irl": _module()},
    {"": _program("  n := x;", "FROM tools IMPORT x;\n"), "tools.irl": _program("")},
    {"": _program("  n := x;", "FROM points IMPORT p0;\n"), "points.irl": _LIST},
    {"": _program("  n := x;", "FROM p IMPORT x;\n")},
    {
        "": _program(
            "  MOVE LIN POSITION(0, 0, 40) IN FRAME pipe; MOVE LIN plate IN FRAME plate; OBSTACLE wall;"
        ),
        "p.toml": _FRAMES.format(model="dual14", link="left_hand") + _WALL,
    },
    {
        "": _program("  MOVE LIN (1, 2, 3); MOVE PTP (10, 20, 30); n := CLEARANCE('wall');"),
        "p.toml": '[robot]\nmodel = "planar3"\n' + _WALL,
    },
    {
        "": "PROGRAM p;\nTYPE RECORD REAL: a1, a2, a3, a4, a5, a6, a7; ENDRECORD = MAIN_JOINT;\n"
        "VAR MAIN_JOINT: j;\nBEGIN\n  j.a1 := 3; MOVE PTP j; FREEZESTART 1, 9;\nENDPROGRAM\n",
        "p.toml": '[robot]\nmodel = "arm7"\n',
    },
    {
        "": _program(
            "  MOVE LIN plate; JOINTLIMIT (1, 2, 3, 4), (5, 6, 7, 8); RECONFIGURATION (1, 2, 3, 4);"
        ),
        "p.toml": _FRAMES.format(model="planar4", link="link_2") + _WALL,
    },
    {"": _program("  MOVE LIN plate;", "SYSTEM SPECIFICATION other;\n"), "other.toml": "[robot\nmodel = 1\n"},
    {"": _LIST, "points.dat": _LIST},
    {"": _module("IMPORT DATALIST points;\n"), "points.dat": _LIST.replace("points", "other")},
    {"": _program("  n := count;", "IMPORT DATALIST points;\n"), "points.dat": _program("")},
    {"": _program("  n := count;", "IMPORT DATALIST points;\n"), "points.dat": "\x00\udcff"},
)
"""A program, and the files beside it by their names."""
