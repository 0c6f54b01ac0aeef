"""Options of the redundancy: switches in any order, and clauses of moves."""

from __future__ import annotations

import numpy as np

from drawn.body import join, number
from drawn.goals import Goals
from drawn.script import LIMIT_TYPES, LIMIT_WORDS, SIDES, Script
from drawn.values import Values

CRITERIA = {
    "VELOCITY_RATIO": False,
    "KINETIC_ENERGY": False,
    "ENERGY_INCREMENT": False,
    "GRAVITY_TORQUE": True,
    "JOINT_CENTRING": True,
    "JOINT_BARRIER": True,
    "MANIPULABILITY": True,
    "SMALLEST_SINGULAR_VALUE": True,
    "DYNAMIC_MANIPULABILITY": True,
}
"""Criteria of the library, and whether they take GAIN."""


class Options:
    """Writes switches and clauses; keeps what is on in the script."""

    def __init__(self, script: Script, values: Values, goals: Goals) -> None:
        self.script, self.rng, self.body, self.values, self.goals = (
            script,
            script.rng,
            script.body,
            values,
            goals,
        )

    def switch(self) -> list[str]:
        """One option on or off."""
        script = self.script
        kinds = ["cyclic", "freeze", *LIMIT_WORDS, "criterion", "criterion", "defaults", "weights"]
        kinds += ["obstacle"] * 2 * bool(self.body.obstacles)
        kind, on = script.pick(kinds), script.chance(0.65)
        if kind in LIMIT_WORDS:
            return self.limit(kind) if on else self.no_limit(kind)
        return getattr(self, kind)(on)

    # ---- Limits

    def bounds(self, kind: str) -> str:
        """Two values with bounds of a kind, wide enough for most moves."""
        rng, body, script = self.rng, self.body, self.script
        lower, upper = body.cell.limits.pair(kind)
        if kind == "position":
            low = np.maximum(body.start - rng.uniform(0.5, 1.5, body.n), lower)
            high = np.minimum(body.start + rng.uniform(0.5, 1.5, body.n), upper)
        else:
            typical = body.speed / body.robot.size * (1.0 if kind == "speed" else 5.0 / body.span)
            size = np.minimum(upper, np.where(np.isfinite(upper), upper, 8.0 * typical)) * rng.uniform(
                0.4, 1.0, body.n
            )
            low, high = np.maximum(-size * rng.uniform(0.7, 1.0), lower), size
            if script.chance(0.04):
                script.note(f"{kind} bound 0")
                joint = int(rng.integers(body.n))
                low[joint] = high[joint] = 0.0
        names = [
            script.holds(f"{LIMIT_TYPES[kind]}_{side}", f"({join(sides * body.units)})")
            for side, sides in zip(SIDES, (low, high), strict=True)
        ]
        return ", ".join(names)

    def limit(self, kind: str) -> list[str]:
        script, body = self.script, self.body
        script.narrowed.add(kind)
        script.note(f"switch {LIMIT_WORDS[kind]}")
        if kind == "position" and script.chance(0.3):
            script.note("limit where a joint stands")
            low, high, joint = script.name("lo"), script.name("hi"), int(self.rng.integers(body.n)) + 1
            script.variables.append(f"MAIN_JOINT_MIN: {low};")
            script.variables.append(f"MAIN_JOINT_MAX: {high};")
            part = f"{low}.A{joint}.MIN" if script.chance(0.5) else f"{high}.A{joint}.MAX"
            return [
                f"{low} := R_JBD.LOWER;",
                f"{high} := R_JBD.UPPER;",
                f"{part} := R_JOINT_ACT.M_JOINT.A{joint};",
                f"JOINTLIMIT {low}, {high};",
            ]
        return [f"{LIMIT_WORDS[kind]} {self.bounds(kind)};"]

    def no_limit(self, kind: str) -> list[str]:
        self.script.narrowed.discard(kind)
        self.script.note(f"switch {LIMIT_WORDS[kind]}END")
        return [f"{LIMIT_WORDS[kind]}END;"]

    # ---- Postures

    def cyclic(self, on: bool) -> list[str]:
        self.script.cyclic = on
        self.script.note("switch CYCLICSTART" if on else "switch CYCLICEND")
        return ["CYCLICSTART;" if on else "CYCLICEND;"]

    def freeze(self, on: bool) -> list[str]:
        spare = self.body.spare
        if not on or not spare:
            self.script.frozen = ()
            self.script.note("switch FREEZEEND")
            return ["FREEZEEND;"]
        # Of two arms only joints of the one that does not carry the tool can be spared at will.
        joints = spare if self.body.robot.hand else self.body.n
        count = int(self.rng.integers(1, spare + 1))
        self.script.frozen = tuple(int(j) + 1 for j in self.rng.choice(joints, count, replace=False))
        self.script.note("switch FREEZESTART")
        return [f"FREEZESTART {', '.join(self.values.int(joint, 2) for joint in self.script.frozen)};"]

    def usually_free(self) -> list[str]:
        """A PTP is mostly refused where a joint is frozen; now and then it may be."""
        if self.script.frozen and self.script.chance(0.95):
            return self.freeze(False)
        return []

    def criterion(self, on: bool) -> list[str]:
        script = self.script
        if not on and script.criteria:
            name = script.pick(sorted(script.criteria))
            script.criteria.discard(name)
            script.note("switch CRITERIONEND")
            return [f"CRITERIONEND {name};"]
        name = script.pick(list(CRITERIA))
        script.criteria.add(name)
        script.note(f"switch CRITERION {name}")
        return [f"CRITERION {name}{self._params(name)};"]

    def _params(self, name: str) -> str:
        found = []
        if self.script.chance(0.6):
            found.append(f"WEIGHT := {self.values.real(float(self.rng.uniform(0.2, 3.0)), 2)}")
        if CRITERIA[name] and self.script.chance(0.6):
            found.append(f"GAIN := {number(self.rng.uniform(0.5, 20.0))}")
        return " " + self.script.pick([", ", " "]).join(found) if found else ""

    def obstacle(self, on: bool) -> list[str]:
        script = self.script
        if not on and script.watched:
            name = script.pick(sorted(script.watched))
            script.watched.discard(name)
            script.note("switch OBSTACLEEND")
            return [f"OBSTACLEEND {name};"]
        name = script.pick(self.body.obstacles)
        script.watched.add(name)
        script.note("switch OBSTACLE")
        return [f"OBSTACLE {name};"]

    # ---- System variables

    def weights(self, on: bool) -> list[str]:
        self.script.note("R_WEIGHTS")
        if on:
            return [f"R_WEIGHTS := ({join(self.rng.uniform(0.5, 12.0, self.body.n))});"]
        joint = int(self.rng.integers(self.body.n)) + 1
        return [f"R_WEIGHTS[{self.values.int(joint, 2)}] := R_WEIGHTS[{joint}] * 1.5;"]

    def defaults(self, on: bool) -> list[str]:
        body, rng, script = self.body, self.rng, self.script
        v = 1e3 * body.speed * float(rng.uniform(0.5, 1.5))
        values = {
            "R_SPEED": v,
            "R_ACC": v / (0.3 * body.span),
            "R_SPEED_ORI": float(rng.uniform(60, 200)),
            "R_ACC_ORI": float(rng.uniform(100, 400)) / body.span,
            "R_SPEED_PTP": float(rng.uniform(20, 100)),
            "R_ACC_PTP": float(rng.uniform(20, 100)),
            "R_C_CP": float(rng.choice([0.0, 0.0, 200.0])) * body.way,
            "R_C_PTP": float(rng.choice([0.0, 0.0, 40.0])),
            "R_JERK": 0.0,
            "R_OVERRIDE": float(rng.uniform(50, 100)),
        }
        name = script.pick([*values, "R_C_PASS", "R_PROFILE"])
        script.note(name)
        if name == "R_C_PASS":
            return [f"R_C_PASS := {self.values.bool(on and script.chance(0.5), 2)};"]
        if name == "R_PROFILE":
            return [f"R_PROFILE := {self.values.string('S_CURVE' if on else 'TRAPEZOID', 2)};"]
        return [f"{name} := {self.values.real(values[name], 1, exact=not values[name])};"]

    # ---- Clauses

    def clauses(self, kind: str, targets: int = 1) -> str:
        """Clauses of a move in any order; `targets` its targets, minus the points of a PATH."""
        script, rng, found = self.script, self.rng, []
        for limit, word in LIMIT_WORDS.items():
            if script.chance(0.05):
                script.note(f"clause {word}")
                found.append(f" WITH {word} {self.bounds(limit)}")
        if script.chance(0.07):
            script.note("clause RECONFIGURATION")
            postures = [self.values.joints(self.goals.posture(0.3)) for _ in range(abs(targets))]
            if script.chance(0.3):
                # One name after the other, so that none of them is taken for an aggregate.
                postures = [
                    script.holds("MAIN_JOINT", f"({join(self.goals.posture(0.3) * self.body.units)})")
                    for _ in postures
                ]
            text = ", ".join(postures)
            found.append(f" WITH RECONFIGURATION {f'({text})' if targets < 0 else text}")
        if script.chance(0.06 if kind != "PTP" else 0.01):
            name = script.pick(list(CRITERIA))
            script.note(f"clause CRITERION {name}")
            found.append(f" WITH CRITERION {name}{self._params(name)}")
        if script.chance(0.06):
            script.note("clause TOLERANCE")
            mm, deg = 200.0 * self.body.way * rng.random(3), rng.uniform(0, 8, 3)
            bands = [*(mm * (rng.random(3) < 0.3)), *(deg * (rng.random(3) < 0.4))]
            bands[5] = float(rng.choice([0.0, bands[5], 360.0]))
            found.append(f" WITH TOLERANCE ({join(bands)})")
        rng.shuffle(found)
        return "".join(found)
