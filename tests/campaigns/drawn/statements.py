"""Statements that are no moves: control flow, calls, signals, waits, texts and files, frames."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from drawn.body import join, number
from drawn.moves import Moves
from drawn.options import Options
from drawn.script import Script
from drawn.values import Values

FREE = (
    "INT: n := 0, m := 3",
    "REAL: x := 1.5",
    "BOOL: flag := FALSE",
    "STRING: word := ''",
    "CHAR: sign := 'a'",
    "POSE: here",
    "MAIN_JOINT: joints",
    "JOINT: both",
    "ROBTARGET: place",
    "ARRAY [0..3] OF INT: counts := (0, 0, 0, 0)",
    "FILE: log, table",
    "INPUT BOOL: part AT 1",
    "DIGITAL OUTPUT: lamp AT 1, horn AT 2",
    "OUTPUT INT: number AT 1",
    "ANALOG OUTPUT: glue AT 2",
    "ANALOG INPUT: level AT 1",
)
"""Variables that statements change; nothing that moves depends on them."""

NUMBERS = "3 4.5 TRUE\nx rest of it\n7, 8; 9\n"
"""The file that programs read."""


def indented(lines: list[str]) -> list[str]:
    return [f"  {line}" for line in lines]


class Statements:
    """Writes statements one after another, each a list of lines."""

    def __init__(self, script: Script, values: Values, moves: Moves, options: Options) -> None:
        self.script, self.rng, self.body = script, script.rng, script.body
        self.values, self.moves, self.options = values, moves, options

    def block(self, moves: int, plain: bool = False) -> list[str]:
        """Statements with so many moves, about; `plain` without what changes options or frames."""
        script, lines = self.script, []
        target = script.moves_left - moves
        while script.moves_left > target:
            chosen = float(self.rng.random())
            if chosen < 0.62 or script.inside > 3:
                lines += self.moves.statement()
            elif chosen < 0.76:
                lines += [] if plain else self.options.switch()
            elif chosen < 0.88:
                lines += self.small()
            else:
                lines += self.compound(plain)
            if script.chance(0.01):
                script.note("empty statement")
                lines.append(";")
        return lines

    # ---- Control flow

    def compound(self, plain: bool) -> list[str]:
        kinds = [self.if_, self.case, self.for_, self.while_, self.repeat, self.goto, self.call, self.visit]
        kinds += [] if plain else [self.in_base, self.with_tool]
        write = self.script.pick(kinds)
        self.script.note(write.__name__.strip("_"))
        self.script.inside += 1
        lines = write()
        self.script.inside -= 1
        return lines

    def _inner(self, moves: int | None = None) -> list[str]:
        return indented(self.block(int(self.rng.integers(1, 3)) if moves is None else moves, True))

    def _dead(self) -> list[str]:
        """Statements that are not reached: what they change does not count."""
        script = self.script
        kept = script.at, script.moves_left, script.frozen, script.cyclic
        lines = self._inner(1)
        script.at, script.moves_left, script.frozen, script.cyclic = kept
        return lines

    def _again(self, times: int) -> list[str]:
        """Statements that are carried out more than once, from wherever the last round ended."""
        self.script.at = None
        before = self.script.moves_left
        lines = self._inner()
        self.script.moves_left -= (times - 1) * (before - self.script.moves_left)
        if times > 1:
            self.script.at = None
        return lines

    def if_(self) -> list[str]:
        values, which = self.values, int(self.rng.integers(4))
        lines = [f"IF {values.bool(which == 0)} THEN", *(self._inner() if which == 0 else self._dead())]
        if self.script.chance(0.5) or which == 1:
            lines += [
                f"ELSIF {values.bool(which == 1)} THEN",
                *(self._inner() if which == 1 else self._dead()),
            ]
        if self.script.chance(0.5) or which == 2:
            lines += ["ELSE", *(self._inner() if which >= 2 else self._dead())]
        return [*lines, "ENDIF;"]

    def case(self) -> list[str]:
        script, values = self.script, self.values
        kind = script.pick(["INT", "CHAR", "STRING", "BOOL"])
        script.note(f"CASE of {kind}")
        if kind == "INT":
            chosen, labels, other = values.int(5), "3, 5..9", "-2..-1"
        elif kind == "CHAR":
            chosen, labels, other = values.char("c"), "'a'..'d'", "'x', 'y'"
        elif kind == "STRING":
            chosen, labels, other = values.string("seam"), "'spot', 'seam'", "'none'"
        else:
            chosen, labels, other = values.bool(True), "TRUE", "FALSE"
        taken = [f"  WHEN {labels}:", *indented(self._inner())]
        left = [f"  WHEN {other}:", *indented(self._dead())]
        default = ["  DEFAULT:", *indented(self._dead())] if script.chance(0.5) and kind != "BOOL" else []
        parts = [*taken, *left] if script.chance(0.5) else [*left, *taken]
        return [f"CASE {chosen} OF", *parts, *default, "ENDCASE;"]

    def for_(self) -> list[str]:
        script, values, times = self.script, self.values, int(self.rng.integers(1, 4))
        kind = script.pick(["TO", "DOWNTO", "STEP", "REAL"])
        script.note(f"FOR {kind}")
        counter = script.name("i")
        script.variables.append(f"{'REAL' if kind == 'REAL' else 'INT'}: {counter};")
        if kind == "DOWNTO":
            head = f"{values.int(times)} DOWNTO 1"
        elif kind == "STEP":
            head = f"1 TO {values.int(2 * times)} STEP 2"
        elif kind == "REAL":
            head = f"0.5 TO {number(0.5 + 0.25 * (times - 1))} STEP 0.25"
        else:
            head = f"{values.int(1)} TO {values.int(times)}"
        return [f"FOR {counter} := {head} DO", *self._again(times), "ENDFOR;"]

    def while_(self) -> list[str]:
        times = int(self.rng.integers(1, 4))
        counter = self.script.name("i")
        self.script.variables.append(f"INT: {counter} := 0;")
        lines = [f"WHILE {counter} < {self.values.int(times)} DO", *self._again(times)]
        return [*lines, f"  {counter} := {counter} + 1;", "ENDWHILE;"]

    def repeat(self) -> list[str]:
        """Left by its condition, or by EXIT."""
        lines = ["REPEAT", *self._again(1)]
        if self.script.chance(0.5):
            self.script.note("EXIT")
            return [*lines, f"  IF {self.values.bool(True)} THEN EXIT; ENDIF;", "UNTIL FALSE;"]
        return [*lines, f"UNTIL {self.values.bool(True)};"]

    def goto(self) -> list[str]:
        """Back to a label once, or forward over what is then left out."""
        script = self.script
        label, counter = script.name("label"), script.name("i")
        script.variables.append(f"INT: {counter} := 0;")
        if script.chance(0.5):
            return [f"GOTO {label};", *(line[2:] for line in self._dead()), f"{label}:"]
        body = [line[2:] for line in self._again(2)]
        return [
            f"{label}:",
            f"{counter} := {counter} + 1;",
            *body,
            f"IF {counter} < 2 THEN GOTO {label}; ENDIF;",
        ]

    # ---- Routines

    def call(self) -> list[str]:
        """A procedure without parameters that moves; it may call the ones before it."""
        script, name = self.script, self.script.name("proc")
        script.at = None
        before = script.moves_left
        local = ["  CONST REAL: half := 0.5;", "  VAR INT: k := 2;"] if script.chance(0.5) else []
        body = self._inner()
        end = ["  RETURN;"] if script.chance(0.3) else []
        used = ["  k := k + ROUND(half);"] if local else []
        script.routines += [f"PROCEDURE {name};", *local, "BEGIN", *used, *body, *end, "ENDPROC;"]
        times = 1 + script.chance(0.3)
        script.moves_left -= (times - 1) * (before - script.moves_left)
        if times > 1:
            script.at = None
        return [f"{name};"] * times

    def visit(self) -> list[str]:
        """A procedure of the program or of its module with a target, and a function of a pose."""
        script, goals = self.script, self.moves.goals
        poses = [goals.of(goals.posture()) for _ in range(int(self.rng.integers(1, 4)))]
        speed = self.values.real(1e3 * self.body.speed, 2)
        lines = []
        for pose in poses:
            text = self.values.pose(pose)
            word = script.pick(["visit", "visit", "called", "same"])
            script.note(f"routine {word}")
            if word == "visit":
                script.needs.add("visit")
                lines.append(f"visit({text}, {speed}, {script.pick(['n', 'm', 'counts[2]'])});")
            elif word == "called":
                script.needs.add("called")
                lines.append(f"called({text});")
            else:
                script.needs.add("same")
                lines.append(f"MOVE LIN same({text}, {self.values.int(3)});")
        self.moves.done(len(poses), poses[-1], "by a routine")
        return lines

    # ---- Frames

    def in_base(self) -> list[str]:
        """Some moves in another R_BASE."""
        script, kept = self.script, self.script.base
        flat = self.body.robot.flat
        place = 0.2 * self.body.robot.size * self.rng.normal(size=3) * (1, 1, not flat)
        turned = (
            Rotation.from_euler("z", float(self.rng.uniform(-3, 3)))
            if flat
            else Rotation.random(rng=self.rng)
        )
        x, y, z, w = turned.as_quat()
        text = f"POSE(POSITION({join(1e3 * place)}), ORIQUAT({join((w, x, y, z))}))"
        if script.chance(0.3):
            text, (place, turned) = "fixture", self.moves.goals.frame("fixture")
        script.base = (place, turned)
        lines = [f"R_BASE := {text};", *self.block(int(self.rng.integers(1, 4)), True)]
        script.base = kept
        return [*lines, "R_BASE := POSE(POSITION(0, 0, 0), ORIQUAT(1, 0, 0, 0));"]

    def with_tool(self) -> list[str]:
        """Some moves with another tool, where the task is whole or in a plane."""
        script, robot = self.script, self.body.robot
        if robot.turns == "none" or robot.kind == "free turns":
            return self.small()
        turn = Rotation.from_rotvec(
            self.rng.normal(size=3) * (0, 0, 1) if robot.turns == "z" else self.rng.normal(size=3)
        )
        place = 0.05 * robot.size * self.rng.normal(size=3) * (1, 1, not robot.flat)
        x, y, z, w = turn.as_quat()
        script.tool = (place, turn)
        script.at = None
        text = f"POSE(POSITION({join(1e3 * place)}), ORIQUAT({join((w, x, y, z))}))"
        lines = [f"R_TOOL := {text};", *self.block(int(self.rng.integers(1, 4)), True)]
        script.tool, script.at = (np.zeros(3), Rotation.identity()), None
        return [*lines, "R_TOOL := POSE(POSITION(0, 0, 0), ORIQUAT(1, 0, 0, 0));"]

    # ---- One line

    def small(self) -> list[str]:
        script, values, span = self.script, self.values, self.body.span
        asked = "R_JOINT_ACT.M_JOINT"
        choices: dict[str, list[str]] = {
            "assignment INT": [f"n := (n + {values.int(3)}) MOD 17;"],
            "assignment REAL": [f"x := {values.real(float(self.rng.normal()))};"],
            "assignment BOOL": [f"flag := {values.bool(script.chance(0.5))} AND NOT flag;"],
            "assignment STRING": [f"word := {values.string('seam ')} + sign;"],
            "assignment CHAR": [f"sign := {values.char('b')};"],
            "assignment of an element": ["counts[n MOD 4] := counts[m MOD 4] + n;"],
            "assignment of a field": [
                "here := R_ROBTARGET_ACT.PSE;",
                f"here.POS.Z := {values.real(12.5, 2)};",
            ],
            "where the robot is": [
                "both := R_JOINT_ACT;",
                "joints := both.M_JOINT;",
                "place := R_ROBTARGET_ACT;",
            ],
            "last move": ["x := R_MOVE_TIME + R_DISTANCE_BACK - R_DISTANCE_FORW;"],
            "FK": [f"here := FK({asked});"],
            "MANIPULABILITY": [f"x := MANIPULABILITY({asked});"],
            "output BOOL": [f"lamp := {values.bool(script.chance(0.5), 2)};"],
            "output INT": [f"number := {values.int(int(self.rng.integers(9)))};"],
            "output REAL": [f"glue := {values.real(float(self.rng.uniform(0, 5)))};"],
            "input": ["IF part THEN horn := TRUE; ELSE horn := FALSE; ENDIF;"],
            "analogue input": ["x := level * 0.5;"],
            "WAIT": [f"WAIT {values.real(span * float(self.rng.choice([0.0, 0.1, 0.5])), 2)} SEC;"],
            "WAIT FOR": [f"WAIT FOR part OR (level > 2.5) TIMEOUT {number(span)} SEC;"],
            "WAIT FOR never": [f"WAIT FOR level > 1000 TIMEOUT {number(0.2 * span)} SEC;"],
            "PAUSE": ["PAUSE;"],
            "WRITE": ["WRITE(n, ' ', x:8:3, flag, word:6);", "WRITELN;"],
            "WRITELN": ["WRITELN('n is', n:4, counts[0]);"],
            "a log": ["OPEN(log, 'log.txt', 'WRITE');", "WRITELN(log, x, ' ', n);", "CLOSE(log);"],
            "APPEND": [
                "OPEN(log, 'more.txt', 'write');",
                "WRITELN(log, n);",
                "CLOSE(log);",
                "OPEN(log, 'more.txt', 'APPEND');",
                "WRITE(log, 'end');",
                "CLOSE(log);",
            ],
            "READ": [
                "OPEN(table, 'numbers.txt', 'READ');",
                "READ(table, n, x, flag);",
                "READ(table, sign, word);",
                "WHILE NOT EOF(table) DO",
                "  READ(table, word);",
                "ENDWHILE;",
                "CLOSE(table);",
            ],
            "function": ["n := turns_of(5) MOD 11;", "turns_of(2);"],
            "comment": ["{ nothing }", "(* nothing either *)"],
        }
        if self.body.obstacles:
            choices["CLEARANCE"] = [f"x := CLEARANCE({asked}, {script.pick(self.body.obstacles)});"]
        if not script.inside:
            choices["READ of STANDARD_IN"] = ["READ(m);"]
        word = script.pick(list(choices))
        script.note(f"small: {word}")
        if word == "READ of STANDARD_IN":
            script.reads.append(str(int(self.rng.integers(1, 9))))
        if word == "function":
            script.needs.add("turns_of")
        return choices[word]
