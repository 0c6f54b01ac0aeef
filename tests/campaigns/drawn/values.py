"""Expressions of every type whose value is known, in all the ways that the language has for it."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from drawn.body import Pose, join, number
from drawn.script import Script

DEEPEST = 3
LETTERS = "abcdefgh xyz_-"


class Values:
    """Writes expressions; what they come to is the value asked for, but for rounding where not `exact`."""

    def __init__(self, script: Script) -> None:
        self.script, self.rng = script, script.rng

    def _deeper(self, depth: int) -> bool:
        """Whether to write an operation rather than the value itself."""
        return depth < DEEPEST and self.rng.random() < (0.2, 0.3, 0.2)[depth]

    # ---- Numbers

    def real(self, value: float, depth: int = 0, exact: bool = False) -> str:
        script, rng, value = self.script, self.rng, float(value)
        if exact or not self._deeper(depth):
            return script.holds("REAL", number(value)) if script.chance(0.12) else number(value)
        other, deep = float(np.round(rng.uniform(0.5, 9.0), 3)), depth + 1
        ways = [
            ("+", lambda: f"({self.real(value - other, deep)} + {self.real(other, deep)})"),
            ("-", lambda: f"({self.real(value + other, deep)} - {self.real(other, deep)})"),
            ("*", lambda: f"{self.real(value / other, deep)} * {self.real(other, deep)}"),
            ("/", lambda: f"{self.real(value * other, deep)} / {self.real(other, deep)}"),
            ("sign", lambda: f"-({self.real(-value, deep)})"),
            ("FLOAT", lambda: f"(FLOAT({self.int(2, deep)}) * {self.real(value / 2, deep)})"),
            (
                "SIN COS",
                lambda: (
                    f"({self.real(value, deep)} * (SIN({other}) * SIN({other})"
                    f" + COS({other}) * COS({other})))"
                ),
            ),
            ("ATAN TAN", lambda: f"({self.real(value, deep)} * TAN(ATAN({other})) / {other})"),
            ("ATAN2", lambda: f"({self.real(value / 45.0, deep)} * ATAN2({other}, {other}))"),
            ("ASIN ACOS", lambda: f"({self.real(value / 90.0, deep)} * (ASIN(0.5) + ACOS(0.5)))"),
            ("EXP LN", lambda: f"({self.real(value, deep)} * EXP(LN({other})) / {other})"),
            (
                "NORM DISTANCE DOT",
                lambda: (
                    f"({self.real(value - other, deep)} + NORM(POSITION(0, 0, {other}))"
                    " - DISTANCE(POSITION(1, 2, 3), (1, 2, 3)) * DOT(POSITION(1, 0, 0), (0, 1, 0)))"
                ),
            ),
            ("field", lambda: f"POSITION({self.real(1.0, deep)}, {self.real(value, deep)}, 0).Y"),
        ]
        if value >= 0.0:
            ways += [
                ("ABS", lambda: f"ABS({self.real(-value, deep)})"),
                ("SQRT", lambda: f"SQRT({self.real(value * value, deep)})"),
            ]
        word, write = script.pick([way for way in ways if way[0] != "field"])
        script.note(f"REAL {word}")
        return write()

    def int(self, value: int, depth: int = 0) -> str:
        script, rng, deep = self.script, self.rng, depth + 1
        if not self._deeper(depth):
            literal = str(value) if value >= 0 else f"(-{-value})"
            return script.holds("INT", literal) if script.chance(0.12) else literal
        k = int(rng.integers(2, 9))
        word, write = script.pick(
            [
                ("+", lambda: f"({self.int(value - k, deep)} + {self.int(k, deep)})"),
                ("-", lambda: f"({self.int(value + k, deep)} - {self.int(k, deep)})"),
                ("*", lambda: f"({self.int(value, deep)} * {self.int(1, deep)})"),
                ("DIV", lambda: f"({self.int(value * k, deep)} DIV {k})"),
                ("MOD", lambda: f"({self.int(value, deep)} MOD {self.int(abs(value) + k, deep)})"),
                ("ROUND", lambda: f"ROUND({number(value + 0.25)})"),
                ("TRUNC", lambda: f"TRUNC({number(value + (0.5 if value >= 0 else -0.5))})"),
                ("ORD CHR", lambda: f"({self.int(value - 97, deep)} + ORD(CHR(97)))"),
                ("LEN", lambda: f"({self.int(value - 3, deep)} + LEN({self.string('abc', deep)}))"),
                ("ABS", lambda: f"({self.int(value - k, deep)} + ABS(-{k}))"),
            ]
        )
        script.note(f"INT {word}")
        return write()

    def bool(self, value: bool, depth: int = 0) -> str:
        script, deep = self.script, depth + 1
        word = "TRUE" if value else "FALSE"
        if depth > DEEPEST or script.chance(0.2):
            return script.holds("BOOL", word) if script.chance(0.15) else word
        other = script.chance(0.5)
        word, write = script.pick(
            [
                ("AND", lambda: f"({self.bool(value, deep)} AND {self.bool(True, deep)})"),
                ("OR", lambda: f"({self.bool(value, deep)} OR {self.bool(False, deep)})"),
                ("EXOR", lambda: f"({self.bool(value != other, deep)} EXOR {self.bool(other, deep)})"),
                ("NOT", lambda: f"NOT {self.bool(not value, deep)}"),
                ("<", lambda: f"({self.real(1.0)} < {self.real(2.0 if value else 0.0)})"),
                (">=", lambda: f"({self.real(1.0)} >= {self.real(0.0 if value else 2.0)})"),
                (">", lambda: f"({self.int(3)} > {self.int(1 if value else 5)})"),
                ("<=", lambda: f"({self.int(3)} <= {self.int(3 if value else 2)})"),
                ("=", lambda: f"({self.int(3)} = {self.int(3 if value else 4)})"),
                ("<> of texts", lambda: f"({self.string('up')} <> {self.string('down' if value else 'up')})"),
                ("< of characters", lambda: f"({self.char('b')} < {self.char('c' if value else 'a')})"),
                ("= of BOOLs", lambda: f"({self.bool(value, deep)} = {self.bool(True, deep)})"),
            ]
        )
        script.note(f"BOOL {word}")
        return write()

    # ---- Texts

    def char(self, value: str) -> str:
        """Never a literal alone, which is a STRING where nothing asks for a CHAR."""
        script, text = self.script, f"'{value}x'"
        held = script.holds("STRING", text) if script.chance(0.5) else ""
        return (
            f"{held}[1]" if held else script.pick([f"CHR({ord(value)})", script.holds("CHAR", f"'{value}'")])
        )

    def string(self, value: str, depth: int = 0) -> str:
        script = self.script
        quoted = "'" + value.replace("'", "''") + "'"
        if depth < DEEPEST and len(value) > 1 and script.chance(0.3):
            script.note("STRING +")
            cut = int(self.rng.integers(1, len(value)))
            return f"({self.string(value[:cut], depth + 1)} + {self.string(value[cut:], depth + 1)})"
        if script.chance(0.2):
            return script.holds("STRING", quoted)
        return quoted if "'" in value or script.chance(0.7) else f'"{value}"'

    # ---- Geometry: mm and Rotation

    def position(self, mm: np.ndarray, depth: int = 0, exact: bool = False) -> str:
        script, rng, deep = self.script, self.rng, depth + 1
        if exact or not self._deeper(depth):
            parts = ", ".join(self.real(x, DEEPEST - 1, exact) for x in mm)
            if script.chance(0.2):
                return script.holds("POSITION", f"({join(mm)})")
            return f"POSITION({parts})"
        other, k = np.round(rng.uniform(-50, 50, 3), 2), float(np.round(rng.uniform(0.5, 4), 2))
        ori = Rotation.random(rng=rng)
        word, write = script.pick(
            [
                ("+", lambda: f"({self.position(mm - other, deep)} + {self.position(other, deep)})"),
                ("-", lambda: f"({self.position(mm + other, deep)} - {self.position(other, deep)})"),
                ("*", lambda: f"({self.position(mm / k, deep)} * {self.real(k, deep)})"),
                ("* number first", lambda: f"({self.real(k, deep)} * {self.position(mm / k, deep)})"),
                ("/ by sign", lambda: f"(-1 * {self.position(-mm, deep)})"),
                (
                    "turned",
                    lambda: f"({self.orientation(ori, deep)} * {self.position(ori.inv().apply(mm), deep)})",
                ),
                (
                    "POS",
                    lambda: (
                        f"{script.holds('POSE', self.pose_of_program((mm, ori), DEEPEST), exact=False)}.POS"
                    ),
                ),
                (
                    "POSE @",
                    lambda: (
                        f"({self.pose_of_program((other, ori), deep)}"
                        f" @ {self.position(ori.inv().apply(mm - other), deep)})"
                    ),
                ),
                (
                    "CROSS",
                    lambda: (
                        f"({self.position(mm - (0, 0, 6.0), deep)} + CROSS(POSITION(2, 0, 0), (0, 3, 0)))"
                    ),
                ),
                (
                    "VECTORS",
                    lambda: (
                        f"(VECTORN({self.orientation(ori, deep)}) * {number(ori.inv().apply(mm)[0])}"
                        f" + VECTORO({self.orientation(ori, deep)}) * {number(ori.inv().apply(mm)[1])}"
                        f" + VECTORA({self.orientation(ori, deep)}) * {number(ori.inv().apply(mm)[2])})"
                    ),
                ),
            ]
        )
        script.note(f"POSITION {word}")
        return write()

    def orientation(self, ori: Rotation, depth: int = 0, exact: bool = False) -> str:
        script, rng, deep = self.script, self.rng, depth + 1
        x, y, z, w = ori.as_quat() * rng.choice([-1.0, 1.0])
        plain = f"{script.pick(['ORIQUAT', 'ORIENTATION'])}({join((w, x, y, z))})"
        if exact or not self._deeper(depth):
            return script.holds("ORIENTATION", f"({join((w, x, y, z))})") if script.chance(0.15) else plain
        other = Rotation.random(rng=rng)
        axis, angle = ori.as_rotvec(), float(ori.magnitude())
        n, o, a = ori.as_matrix().T
        order = script.pick(["XYZ", "YXZ", "ZYX"])
        held = f"POSE(POSITION(1, 2, 3), {plain})"
        ways = [
            (f"ORI{order}", lambda: f"ORI{order}({join(ori.as_euler(order, degrees=True))})"),
            ("ORIZYZ2", lambda: f"ORIZYZ2({join(ori.as_euler('ZYZ', degrees=True))})"),
            ("ORIMAT", lambda: f"ORIMAT(({join(n)}), ({join(o)}), ({join(a)}))"),
            (
                "ORIRS",
                lambda: (
                    f"ORIRS((1, 2, 3), ({join(n * 50 + (1, 2, 3))}), ({join(n * 20 + o * 30 + (1, 2, 3))}))"
                ),
            ),
            ("INV", lambda: f"INV({self.orientation(ori.inv(), deep)})"),
            ("@", lambda: f"({self.orientation(ori * other, deep)} @ {self.orientation(other.inv(), deep)})"),
            ("ROTAXIS ROTANGLE", lambda: f"ORIVANG(ROTAXIS({plain}), ROTANGLE({plain}))"),
            (
                "QUATA to QUATD",
                lambda: f"ORIQUAT(QUATA({plain}), QUATB({plain}), QUATC({plain}), QUATD({plain}))",
            ),
            (
                "ANGLEX ANGLEY ANGLEZ",
                lambda: f"ORI{order}({', '.join(f'ANGLE{c}({order!r}, {plain})' for c in order)})",
            ),
            ("ORI", lambda: f"{script.holds('POSE', held, exact=False)}.ORI"),
        ]
        if angle > 1e-3:
            ways.append(
                ("ORIVANG", lambda: f"ORIVANG(({join(axis / angle * 3.0)}), {number(np.degrees(angle))})")
            )
        word, write = script.pick(ways)
        script.note(f"ORIENTATION {word}")
        return write()

    def pose(self, pose: Pose, depth: int = 0, exact: bool = False) -> str:
        """A pose of the root frame (m), as the program has to write it: in R_BASE, mm."""
        base = self.script.base
        turn = base[1].inv()
        return self.pose_of_program((1e3 * turn.apply(pose[0] - base[0]), turn * pose[1]), depth, exact)

    def point(self, position: np.ndarray, exact: bool = False) -> str:
        """A position of the root frame (m) in R_BASE."""
        base = self.script.base
        return self.position(1e3 * base[1].inv().apply(position - base[0]), exact=exact)

    def pose_of_program(self, pose: Pose, depth: int = 0, exact: bool = False) -> str:
        script, rng, deep = self.script, self.rng, depth + 1
        (mm, ori), inner = pose, DEEPEST - 1
        if exact or not self._deeper(depth):
            plain = f"POSE({self.position(mm, inner, exact)}, {self.orientation(ori, inner, exact)})"
            if script.chance(0.25):
                x, y, z, w = ori.as_quat()
                return script.holds("POSE", f"(({join(mm)}), ({join((w, x, y, z))}))")
            return plain
        other = np.round(rng.uniform(-50, 50, 3), 2), Rotation.random(rng=rng)
        after = other[1].inv().apply(mm - other[0]), other[1].inv() * ori
        inverse = -ori.inv().apply(mm), ori.inv()
        shift = np.round(rng.uniform(-20, 20, 3), 2)
        word, write = script.pick(
            [
                ("@", lambda: f"({self.pose_of_program(other, deep)} @ {self.pose_of_program(after, deep)})"),
                ("INV", lambda: f"INV({self.pose_of_program(inverse, deep)})"),
                ("+", lambda: f"({self.pose_of_program((mm - shift, ori), deep)} + ({join(shift)}))"),
                ("-", lambda: f"({self.pose_of_program((mm + shift, ori), deep)} - POSITION({join(shift)}))"),
                (
                    "aggregate behind @",
                    lambda: (
                        f"({self.pose_of_program(other, deep)}"
                        f" @ (({join(after[0])}), {self.orientation(after[1], deep)}))"
                    ),
                ),
            ]
        )
        script.note(f"POSE {word}")
        return write()

    # ---- Postures

    def joints(self, q: np.ndarray, exact: bool = True) -> str:
        """A MAIN_JOINT (rad, m in; degrees, mm out)."""
        script, values = self.script, self.script.body.values(q)
        plain = join(values)
        word = script.pick(["declared", "declared", "aggregate", "typed", "changed", "JOINT"])
        script.note(f"joints {word}")
        if word == "declared":
            return script.holds("MAIN_JOINT", f"({plain})")
        if word == "aggregate" and script.body.n not in {3, 4, 6}:
            return f"({plain})"
        if word == "JOINT":
            return f"{script.holds('JOINT', f'JOINT(({plain}))', exact=False)}.M_JOINT"
        return f"MAIN_JOINT({plain})"
