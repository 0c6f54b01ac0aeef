"""MOVE statements of every kind, with their parameters and clauses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from drawn.body import Pose, join, number
from drawn.goals import Goals
from drawn.options import Options
from drawn.script import Script
from drawn.values import Values


class Moves:
    """Writes moves; keeps the place of the tool in the script."""

    def __init__(self, script: Script, values: Values, goals: Goals, options: Options) -> None:
        self.script, self.rng, self.body = script, script.rng, script.body
        self.values, self.goals, self.options = values, goals, options

    def statement(self) -> list[str]:
        """One move, now and then several; tells the script how many moves that are."""
        kinds: list[tuple[float, Callable[[], list[str]]]] = [
            (6.0, self.line),
            (1.0, self.several_lines),
            (1.5, self.to_position),
            (1.0, self.line_to_joints),
            (2.0, self.increment),
            (2.0, self.arc),
            (1.0, self.rounds),
            (2.0, self.path),
            (1.0, self.path_of_an_array),
            (4.0, self.ptp_to_joints),
            (0.8, self.ptp_to_pose),
            (1.0, self.ptp_increment),
            (0.7, self.robtarget),
            (1.0, self.in_fixture),
            (0.6, self.to_a_posture_asked_for),
            (1.0, self.reconfiguration),
            (0.5, self.closed_loop),
            (0.15, self.half_turn),
        ]
        if self.body.hand_frame:
            kinds.append((4.0, self.in_hand))
        weights = np.array([weight for weight, _ in kinds])
        return kinds[int(self.rng.choice(len(kinds), p=weights / weights.sum()))][1]()

    def done(self, moves: int, at: Pose | None, kind: str) -> None:
        self.script.moves_left -= moves
        self.script.at = at
        self.script.note(f"move: {kind}")

    # ---- Parameters and clauses

    def law(self, kind: str) -> str:
        """Parameters of the MOVE, with commas or without."""
        rng, body, script = self.rng, self.body, self.script
        v = 1e3 * body.speed * float(rng.uniform(0.4, 2.0))
        words = {
            "SPEED": (0.2, v),
            "ACC": (0.15, v / (body.span * float(rng.uniform(0.1, 0.6)))),
            "SPEED_ORI": (0.1, float(rng.uniform(40, 200))),
            "ACC_ORI": (0.1, float(rng.uniform(100, 400)) / body.span),
            "OVERRIDE": (0.08, float(rng.uniform(30, 100))),
            "JERK": (0.06, float(rng.choice([0.0, v / (0.05 * body.span**2)]))),
        }
        if kind == "PTP":
            words["SPEED_PTP"] = words["ACC_PTP"] = (0.25, float(rng.uniform(20, 100)))
            words["C_PTP"] = (0.25, float(rng.choice([0.0, 1e-7, 20.0, 100.0])))
        else:
            words["C_CP"] = (0.3, float(rng.choice([0.0, 1e-7, 0.2, 1.0])) * 1e3 * body.way)
        found = [
            f"{word} := {self.values.real(x, 2, exact=x in (0.0, 100.0))}"
            for word, (p, x) in words.items()
            if script.chance(p)
        ]
        if script.chance(0.1):
            found.append(f"C_PASS := {self.values.bool(script.chance(0.6), 2)}")
        if script.chance(0.1):
            found.append(
                f"PROFILE := {self.values.string(script.pick(['TRAPEZOID', 'S_CURVE', 's_curve']), 2)}"
            )
        if script.chance(0.02):
            found.append(
                f"TIME := {number(body.span * float(rng.choice([1e-3, 30.0, 60.0], p=[0.02, 0.58, 0.4])))}"
            )
        for one in found:
            script.note(f"parameter {one.split(' ')[0]}")
        return " " + script.pick([", ", " "]).join(found) if found else ""

    def tail(self, kind: str, targets: int = 1) -> str:
        return self.law(kind) + self.options.clauses(kind, targets)

    # ---- Lines

    def line(self) -> list[str]:
        pose = self.goals.pose()
        self.done(1, pose, "LIN to a pose")
        return [f"MOVE LIN {self.values.pose(pose)}{self.tail('LIN')};"]

    def several_lines(self) -> list[str]:
        poses = [self.goals.pose() for _ in range(int(self.rng.integers(2, 4)))]
        self.done(len(poses), poses[-1], "LIN to several targets")
        return [f"MOVE LIN {', '.join(map(self.values.pose, poses))}{self.tail('LIN', len(poses))};"]

    def to_position(self) -> list[str]:
        """Positions keep the orientation: a way from where the tool is, which most robots can do."""
        if self.script.at is None:
            return self.line()
        way = self.goals.shift(self.body.way * float(self.rng.choice([1e-9, 0.2, 0.5])))
        at = self.script.at[0] + way, self.script.at[1]
        kind = self.script.pick(["LIN"] * 6 + ["PTP"])
        self.done(1, at, f"{kind} to a position")
        return [f"MOVE {kind} {self.values.point(at[0])}{self.tail(kind)};"]

    def line_to_joints(self) -> list[str]:
        q = self.goals.posture()
        self.done(1, self.goals.of(q), "LIN to joints")
        return [f"MOVE LIN {self.values.joints(q)}{self.tail('LIN')};"]

    def increment(self) -> list[str]:
        script, values = self.script, self.values
        way = self.goals.shift(self.body.way * float(self.rng.choice([0.0, 1e-9, 0.2, 0.5])))
        local = script.base[1].inv().apply(way)
        if script.chance(0.6):
            at = None if script.at is None else (script.at[0] + way, script.at[1])
            self.done(1, at, "MOVE_INC by a position")
            return [f"MOVE_INC LIN {values.position(1e3 * local)}{self.tail('LIN')};"]
        there = self.goals.turn(self.body.spread)
        here = way if not self.body.robot.flat else np.array([*way[:2], 0.0])
        size = self.body.way * 0.2
        inner = (
            size * here / max(float(np.linalg.norm(here)), 1e-30)
            if self.body.robot.turns == "all"
            else 0.0 * here
        )
        at = None if script.at is None else (script.at[0] + script.at[1].apply(inner), script.at[1] * there)
        self.done(1, at, "MOVE_INC by a pose")
        return [f"MOVE_INC LIN {values.pose_of_program((1e3 * inner, there))}{self.tail('LIN')};"]

    # ---- Circles

    def arc(self) -> list[str]:
        before = [] if self.script.at is not None else self.line()
        at = self.script.at
        via, end = self.goals.circle(at, float(self.rng.uniform(20, 150)), float(self.rng.uniform(160, 350)))
        turns = [at[1] * self.goals.turn(self.body.spread * self.script.chance(0.5)) for _ in range(2)]
        words = " CIRC_ORI := 'VIA'" if self.script.chance(0.3) else ""
        self.done(1, (end, turns[1]), "CIRCLE")
        points = f"{self.values.pose((via, turns[0]))}, {self.values.pose((end, turns[1]))}"
        if self.body.robot.turns == "none" or self.script.chance(0.3):
            self.script.at = (end, at[1])
            points, words = f"{self.values.point(via)}, {self.values.point(end)}", ""
        return [*before, f"MOVE CIRCLE {points}{words}{self.tail('CIRCLE')};"]

    def rounds(self) -> list[str]:
        before = [] if self.script.at is not None else self.line()
        at, angle = self.script.at, float(self.rng.choice([-400.0, -90.0, 1e-3, 30.0, 360.0, 720.0]))
        via, end = self.goals.circle(at, 80.0, 170.0)
        self.done(1, at if angle % 360.0 == 0.0 else None, "CIRCLE by an angle")
        points = f"{self.values.point(via)}, {self.values.point(end)}"
        return [
            *before,
            f"MOVE CIRCLE {points} ANGLE := {self.values.real(angle, exact=True)}{self.tail('CIRCLE')};",
        ]

    # ---- Paths

    def points(self) -> list[Pose]:
        """Points of a PATH, neighbours apart but for a share of them."""
        found = [self.goals.of(self.goals.plain()) for _ in range(int(self.rng.integers(1, 5)))]
        if self.script.chance(0.01):
            self.script.note("PATH with the same point twice")
            found.append(found[-1])
        return found

    def path(self) -> list[str]:
        points = self.points()
        kind = self.script.pick(["LIN", "SPLINE"])
        self.done(1, points[-1], f"{kind} PATH")
        text = ", ".join(map(self.values.pose, points))
        if len(points) == 1:
            text = f"{text}"
        clauses = self.options.clauses(kind, -len(points))
        return [f"MOVE {kind} PATH ({text}){self.law(kind)}{clauses};"]

    def path_of_an_array(self) -> list[str]:
        points = self.points()
        kind, name = self.script.pick(["LIN", "SPLINE"]), self.script.name("p")
        local = [self._in_base(pose) for pose in points]
        values = ", ".join(self.values.pose_of_program(pose, exact=True) for pose in local)
        shape = f"ARRAY [1..{len(points)}] OF POSE"
        if len(points) == 1:
            return self.path()
        self.script.variables.append(f"{shape}: {name} := ({values});")
        last = self.goals.of(self.goals.posture())
        more, at = (
            (f"({name}, {self.values.pose(last)})", last) if self.script.chance(0.4) else (name, points[-1])
        )
        self.done(1, at, f"{kind} PATH of an array")
        return [f"MOVE {kind} PATH {more}{self.law(kind)};"]

    def _in_base(self, pose: Pose) -> Pose:
        base = self.script.base
        return 1e3 * base[1].inv().apply(pose[0] - base[0]), base[1].inv() * pose[1]

    # ---- Joints

    def ptp_to_joints(self) -> list[str]:
        before = self.options.usually_free()
        q = self.goals.posture()
        targets, last = [self.values.joints(q)], q
        if self.script.chance(0.2):
            last = self.goals.posture()
            targets.append(self.values.joints(last))
        self.done(len(targets), self.goals.of(last), "PTP to joints")
        return [*before, f"MOVE PTP {', '.join(targets)}{self.tail('PTP', len(targets))};"]

    def ptp_to_pose(self) -> list[str]:
        before = self.options.usually_free()
        pose = self.goals.pose()
        self.done(1, pose, "PTP to a pose")
        return [*before, f"MOVE PTP {self.values.pose(pose)}{self.tail('PTP')};"]

    def ptp_increment(self) -> list[str]:
        before = self.options.usually_free()
        way = (
            0.5 * self.body.spread * self.rng.normal(size=self.body.n) * (self.rng.random(self.body.n) < 0.4)
        )
        way *= float(self.rng.choice([1.0, 1.0, 1e-16, 0.0]))
        if self.body.relation is not None:
            a, b, factor = self.body.relation
            way[a] = -factor * way[b]
        self.done(1, None, "MOVE_INC of joints")
        return [*before, f"MOVE_INC PTP MAIN_JOINT({join(way * self.body.units)}){self.law('PTP')};"]

    def to_a_posture_asked_for(self) -> list[str]:
        """Joint values that the robot gives: its own with one changed, IK, POSTURE."""
        script, pose, name = self.script, self.goals.of(self.goals.posture()), self.script.name("q")
        script.variables.append(f"MAIN_JOINT: {name};")
        before = self.options.usually_free()
        word = script.pick(["R_JOINT_ACT", "IK", "POSTURE", "POSTURE of an obstacle"])
        if word.startswith("POSTURE of") and not self.body.obstacles:
            word = "POSTURE"
        script.note(f"asked: {word}")
        kind = script.pick(["PTP", "LIN"])
        self.done(1, None if word == "R_JOINT_ACT" else pose, f"{kind} to joints asked for")
        text = self.values.pose(pose, 2)
        if word == "R_JOINT_ACT":
            joint = int(self.rng.integers(self.body.n)) + 1
            size = 0.3 * self.body.spread * self.body.units[joint - 1] * self.rng.normal()
            lines = [
                f"{name} := R_JOINT_ACT.M_JOINT;",
                f"{name}.A{joint} := {name}.A{joint} + {number(size)};",
            ]
        elif word == "IK":
            lines = [f"{name} := IK({text}, R_JOINT_ACT.M_JOINT);"]
        else:
            of = f", {script.pick(self.body.obstacles)}" if word != "POSTURE" else ""
            lines = [f"{name} := POSTURE({text}{of});"]
        return [*before, *lines, f"MOVE {kind} {name}{self.tail(kind)};"]

    def robtarget(self) -> list[str]:
        pose, name = self.goals.pose(), self.script.name("r")
        more = self.script.pick(["", ", 0", f", 0, ({', '.join(['0'] * self.body.n)})"])
        exact = self.values.pose_of_program(self._in_base(pose), exact=True)
        self.script.variables.append(f"ROBTARGET: {name} := ROBTARGET({exact}{more});")
        self.done(1, pose, "to a ROBTARGET")
        return [f"MOVE LIN {name}{self.tail('LIN')};"]

    # ---- Frames of the cell

    def in_fixture(self) -> list[str]:
        """In a frame that stands still, which counts as the base of this one move."""
        script, kept = self.script, self.script.base
        pose = self.goals.pose()
        script.base = self.goals.frame("fixture")
        text = self.values.pose(pose)
        script.base = kept
        kind = script.pick(["LIN", "LIN", "LIN", "PTP"])
        self.done(1, pose, "IN FRAME that stands")
        return [f"MOVE {kind} {text} IN FRAME fixture{self.tail(kind)};"]

    def in_hand(self) -> list[str]:
        """In the frame that the other hand carries: both hands move."""
        script, kept = self.script, self.script.base
        poses = [
            self.goals.in_hand(self.goals.posture(0.5 * self.body.spread))
            for _ in range(int(self.rng.integers(1, 3)))
        ]
        script.base = (np.zeros(3), kept[1].identity())
        texts = [self.values.pose(pose) for pose in poses]
        script.base = kept
        self.done(len(texts), None, "IN FRAME of a hand")
        kind = script.pick(["LIN", "LIN", "PTP", "LIN PATH"])
        targets = f"({', '.join(texts)})" if kind == "LIN PATH" else ", ".join(texts)
        return [f"MOVE {kind} {targets} IN FRAME {self.body.hand_frame}{self.law(kind[:3])};"]

    # ---- Whole ideas

    def reconfiguration(self) -> list[str]:
        q = self.goals.posture(0.3)
        self.script.moves_left -= 1
        self.script.note("move: RECONFIGURATION")
        where = (
            f" IN FRAME {self.body.hand_frame}" if self.body.hand_frame and self.script.chance(0.5) else ""
        )
        return [f"RECONFIGURATION {self.values.joints(q)}{where};"]

    def closed_loop(self) -> list[str]:
        """Round a triangle from a pose that is known to the last digit, under CYCLICSTART."""
        corner = self.values.pose(pose := self.goals.of(self.goals.posture()), exact=True)
        others = [self.values.pose(self.goals.of(self.goals.posture())) for _ in range(2)]
        self.done(4, pose, "closed loop")
        self.script.cyclic = False
        return [
            f"MOVE LIN {corner};",
            "CYCLICSTART;",
            *(f"MOVE LIN {one};" for one in [*others, corner]),
            "CYCLICEND;",
        ]

    def half_turn(self) -> list[str]:
        """Nearly or exactly half a turn, which has no axis."""
        if self.script.at is None or self.body.robot.turns != "all":
            return self.line()
        angle = np.radians(float(self.rng.choice([120.0, 179.9999, 180.0])))
        at = self.script.at
        pose = at[0], at[1] * at[1].from_rotvec([0.0, 0.0, angle])
        self.done(1, pose, "half a turn")
        return [f"MOVE LIN {self.values.pose(pose, exact=True)};"]
