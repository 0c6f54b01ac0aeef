"""How values of every type may be written, by the tables of the reference: for random programs."""

from __future__ import annotations

OPEN, CLOSE = "\x01", "\x02"
"""Parentheses that only the long way to write a program has."""
PRIMARY, SIGNED, COMPOSED, TIMES, PLUS, COMPARED, AND, EXOR, OR = range(9, 0, -1)
RANKS = {"@": COMPOSED, "*": TIMES, "/": TIMES, "DIV": TIMES, "MOD": TIMES, "+": PLUS, "-": PLUS}
RANKS |= {"AND": AND, "EXOR": EXOR, "OR": OR}
RANKS |= dict.fromkeys(("=", "<>", "<", ">", "<=", ">="), COMPARED)

TYPES = """TYPE
  RECORD INT: n; REAL: x; STRING: s; ENDRECORD = item;
  RECORD item: first; ARRAY [0..2] OF item: rest; REAL: a1.max, a1.s.max; BOOL: done; ENDRECORD = box;
  ARRAY [1..3] OF INT = triple;
  ARRAY [-1..1, 0..2] OF REAL = grid;
  ARRAY [1..2] OF POSITION = points;
"""
WRITTEN = {"near": "REAL", "joints": "MAIN_JOINT", "target": "ROBTARGET", "full": "JOINT"}
"""How the types are called in a program that are called otherwise here."""
PARTS = {
    "item": (("int", ".n"), ("real", ".x"), ("string", ".s")),
    "box": (
        ("item", ".first"),
        ("int", ".first.n"),
        ("item", ".rest[{2}]"),
        ("real", ".rest[{2}].x"),
        ("real", ".a1.max"),
        ("real", ".a1.s.max"),
        ("bool", ".done"),
    ),
    "triple": (("int", "[{1}]"), ("int", "[{any}]")),
    "grid": (("real", "[{0}, {2}]"), ("real", "[{0}, {any}]")),
    "points": (("position", "[{p}]"), ("near", "[{p}].y")),
    "position": (("near", ".x"), ("near", ".z")),
    "pose": (("position", ".pos"), ("orientation", ".ori"), ("near", ".pos.y")),
    "joints": (("real", ".a1"), ("real", ".a7")),
    "target": (("pose", ".pse"), ("int", ".status"), ("int", ".turns[{1}]")),
    "full": (("joints", ".m_joint"), ("real", ".m_joint.a2")),
}
"""Parts of structures: their type, and how they are selected; an index is within bounds, or any."""
SETTABLE = ("int", "real", "bool", "string", "char", "near", "position", "orientation", "pose")
SETTABLE += ("item", "box", "triple", "grid", "points", "joints", "target", "full")

WAYS = {
    "int": "{int} + {int}|{int} - {int}|{int} * {int}|{int} DIV {int}|{int} MOD {int}|{int} MOD {divisor}"
    "|-{int}|ABS({int})|ROUND({real})|TRUNC({real})|ORD({char})|LEN({string})|ORD({string letter})|+{int}",
    "real": "{real} + {real}|{real} - {int}|{int} * {real}|{real} / {real}|{int} / {int}|-{real}|ABS({real})"
    "|SQRT({real})|SQRT(ABS({real}))|FLOAT({int})|{real} * {real}",
    "bool": "{int} < {int}|{int} >= {real}|{real} = {real}|{int} <> {int}|{bool} AND {bool}|{bool} OR {bool}"
    "|{bool} EXOR {bool}|NOT {bool}|{string} = {string}|{char} <> {string}|{char name} < {char}"
    "|{bool} = {bool}|{char} >= {char name}|{real} <= {int}",
    "string": "{string} + {string}|{char} + {string}|{string} + {char}|{char} + {char}",
    "char": "CHR(97 + {int} MOD 20)|CHR({int})|{string letter}",
    "near": "{near} + {near}|{near} - {real}|{near} * {small}|SIN({real})|COS({near})|ATAN({real})"
    "|TAN({real})|ATAN2({real}, {real})|ASIN({real})|ACOS({real} / {small})|LN({real})"
    "|EXP(SIN({real}))|NORM({position})"
    "|DOT({position}, {position}) / 1000|DISTANCE({position}, {position})|DISTANCE({pose}, {pose})"
    "|ROTANGLE({orientation})|ABS(QUATA({orientation}))|-{near}",
    "position": "{position} + {position}|{position} - {position}|{position} * {small}|{small} * {position}"
    "|{position} / {real}|{orientation} * {position}|{pose} @ {position}|POSITION({real}, {int}, {near})"
    "|{position} + ({real}, {int}, 1.5)|({small}, {near}, 2) - {position}|{pose} @ (1, {small}, {near})"
    "|{orientation} * ({small}, 2, 3)|CROSS({position}, {position}) / 1000|VECTORN({orientation})"
    "|VECTORO({orientation})|VECTORA({orientation})|({small}, 2, {near}) / {small}",
    "orientation": "{orientation} @ {orientation}|INV({orientation})|ORIXYZ({near}, {small}, 30)"
    "|ORIYXZ(10, {near}, {real})|ORIZYX({small}, {near}, {near})|ORIZYZ2({near}, 20, {small})"
    "|ORIVANG(({small}, {small}, {digit}), {near})|ORIQUAT(0.5, 0.5, -0.5, 0.5)|ORIQUAT(0.6, 0, 0.8, 0)"
    "|ORIMAT(VECTORN({same}), VECTORO({same}), VECTORA({same}))|ORIVANG(ROTAXIS({same}), ROTANGLE({same}))"
    "|ORIXYZ(ANGLEX('XYZ', {same}), ANGLEY('XYZ', {same}), ANGLEZ('XYZ', {same}))"
    "|ORIZYX(ANGLEZ('ZYX', {same}), ANGLEY('zyx', {same}), ANGLEX('ZYX', {same}))"
    "|ORIYXZ(ANGLEY('YXZ', {same}), ANGLEX('YXZ', {same}), ANGLEZ('YXZ', {same}))"
    "|ORIZYZ2(ANGLEZ('ZYZ2', {same}), ANGLEY('ZYZ2', {same}), ANGLEX('ZYZ2', {same}))"
    "|ORIRS(({small}, 1, 2), ({digit}, 5, {digit}), (8, {digit}, 1))",
    "pose": "{pose} @ {pose}|{pose} + {position}|{pose} - ({small}, 2, {near})|INV({pose})"
    "|POSE({position}, {orientation})|({position}, {orientation}) @ {pose}"
    "|{pose} @ ({position}, {orientation})",
}
"""Ways to write a value of a type, by the tables of the reference."""
VALUES = {
    "position": "({real}, {int}, {near})",
    "orientation": "(0.6, 0.8, 0, 0)",
    "pose": "({position=}, {orientation=})",
    "item": "({int}, {real}, {string})",
    "box": "({item=}, ({item=}, {item=}, {item=}), {real}, {int}, {bool})",
    "triple": "({int}, {int}, {int})",
    "grid": "({real}, 1, 2.5, {int}, 0, 1, 2, 3, {real})",
    "points": "({position=}, {position=})",
    "joints": "({real}, {int}, 0, 1, 2.5, -3, {small})",
}
"""Lists of values, where the type is expected."""
NAMED = {
    "item": "item({int}, {real}, {string})",
    "joints": "MAIN_JOINT(1, {real}, 3, 4, 5, {int}, 7)",
    "triple": "triple(1, {int}, 3)",
    "target": "ROBTARGET({pose=}, {int}, (1, 2, 3, 4, 5, {int}, 7))",
    "full": "JOINT({joints=})",
}
LITERALS = {
    "int": ("0", "1", "2", "3", "5", "17", "-1", "-4", "1000003"),
    "real": ("0.", ".5", "1.5", "-2.25", "1E3", "0.1", "3", "1.7E-5"),
    "bool": ("TRUE", "FALSE"),
    "string": ("''", "'up'", "'it''s'", "'a b'", '"zéta"'),
    "char": ("'a'", "'q'", "' '"),
    "near": ("0.25", "1.5", "-30.", "72"),
    "position": ("POSITION(1, 2, 3)",),
    "orientation": ("ORIQUAT(1, 0, 0, 0)",),
    "pose": ("POSE(POSITION(100, 0, 5), ORIXYZ(0, 30, 0))",),
    "item": ("item(4, 0.5, 'x')",),
    "joints": ("MAIN_JOINT(0, 10, 20, 30, 40, 50, 60)",),
    "full": ("JOINT(MAIN_JOINT(0, 10, 20, 30, 40, 50, 60))",),
    "target": ("ROBTARGET(POSE(POSITION(1, 2, 3), ORIQUAT(1, 0, 0, 0)))",),
}
EDGES = ("9223372036854775807", "(-9223372036854775807 - 1)", "4611686018427387904", "3037000500")
STARTS = {
    "int": (*EDGES[:1], "0", "1", "3", "-7", "12"),
    "box": ("((1, 2, 'b'), ((1, 1, ''), (2, .5, 'y'), (3, 0, 'z')), 1, 2.5, FALSE)",),
    "triple": ("(4, 0, -2)",),
    "grid": ("(0, 1, 2, 3, 4, 5.5, 6, 7, 8)",),
    "points": ("((1, 2, 3), (4, 5, 6))",),
}
