"""Random Newton steps, compact against the full problem with its equality rows, in exact arithmetic (TRF-01).

The problem is min g'd + 1/2 d'Hd, J d = e, lower <= d <= upper. Its truth is found in rational numbers:
floats are rational, so nothing rounds. The dual active-set method of this file keeps the rows of J as rows
and knows no null space. What it says is believed only with a certificate that is checked apart from it:
the conditions of Karush, Kuhn and Tucker for an optimum, Farkas' combination of rows for "no step".

Problems that a rounding can open or close (1e-16 residues where several bounds meet, a solution that is a
single point) have no answer that a solver in floats could be held to. Where bounds wider or narrower by
`BRINK` (rad or m) change the answer, both are right; a step that is given keeps path and bounds all the same.

A failing step is repeated by its seed, which is in the message: `drawn(seed)`.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter

import numpy as np
import pytest

from irlx.transform.compact import StepProblem, bounded_step, free_step, within
from irlx.transform.precision import QP_EXCESS
from irlx.transform.qp.proxqp import ProxQpSolver

pytestmark = pytest.mark.req("TRF-01")

QUICK, LONG, PORTION = 80, 12_800, 1_280
ACCURACY, BRINK = 1e-9, 1e-12
KINDS = (
    "active",
    "weak",
    "redundant",
    "pinned",
    "zeros",
    "on limit",
    "touching",
    "residue",
    "scaled",
    "singular",
    "open",
    "forward",
    "infeasible",
)
ONCE_WRONG = {
    914: "rows of pure rounding (joints that the path alone holds) taken for slopes",
    2695: "held rows that depend on each other not looked at",
    4853: "rows of pure rounding taken for slopes",
    8337: "rows of pure rounding taken for slopes",
    4962: "bounds of three joints that miss each other by 5e-11 counted as meeting",
    7666: "a nearly singular J, its condition squared by J H^-1 J'",
    10786: "a nearly singular J, its condition squared by J H^-1 J'",
}
"""Seeds of problems that the compact step once did not solve, and why."""
Vector = list[Fraction]


@dataclass(frozen=True)
class Exact:
    """The problem in rational numbers; a bound is None where there is none."""

    rows: list[Vector]
    twist: Vector
    gradient: Vector
    hessian: Vector
    lower: list[Fraction | None]
    upper: list[Fraction | None]


@dataclass(frozen=True)
class Optimum:
    """Step d (n,), multipliers k (m,) of the rows and of the bounds (n,): > 0 pushes up, < 0 down."""

    d: Vector
    k: Vector
    pushes: Vector


@dataclass(frozen=True)
class Contradiction:
    """Combination y (m,) of the rows: y'J d = y'e lies outside what the bounds allow y'J d."""

    y: Vector


def exact(problem: StepProblem, widen: float = 0.0) -> Exact:
    def vector(values: np.ndarray) -> Vector:
        return [Fraction(value) for value in values.tolist()]

    def bounds(values: np.ndarray, by: float) -> list[Fraction | None]:
        return [Fraction(v) + Fraction(by) if math.isfinite(v) else None for v in values.tolist()]

    return Exact(
        [vector(row) for row in problem.jacobian],
        vector(problem.twist),
        vector(problem.gradient),
        vector(problem.hessian),
        bounds(problem.lower, -widen),
        bounds(problem.upper, widen),
    )


def solved(matrix: list[Vector], right: Vector) -> Vector:
    """Solution of a regular system by Bareiss' elimination, in whole numbers."""
    size = len(right)
    table = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    unit = math.lcm(*(value.denominator for row in table for value in row))
    whole = [[value.numerator * (unit // value.denominator) for value in row] for row in table]
    before = 1
    for k in range(size):
        pivot = next(i for i in range(k, size) if whole[i][k])
        whole[k], whole[pivot] = whole[pivot], whole[k]
        top = whole[k]
        for i in range(size):
            if i != k:
                row = whole[i]
                whole[i] = [(top[k] * a - row[k] * b) // before for a, b in zip(row, top, strict=True)]
        before = top[k]
    return [Fraction(row[size], row[i]) for i, row in enumerate(whole)]


def dot(a: Vector, b: Vector) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def combined(p: Exact, y: Vector) -> Vector:
    """J'y."""
    return [dot(list(column), y) for column in zip(*p.rows, strict=True)]


def moved(p: Exact, free: list[int], wish: Vector, twist: Vector) -> tuple[Vector, Vector]:
    """z and y of min 1/2 z'Hz - wish'z, J z = twist, where only `free` joints move: H z = wish + J'y."""
    pulls = [[row[j] / p.hessian[j] for j in free] for row in p.rows]
    taken = [[row[j] for j in free] for row in p.rows]
    gram = [[dot(pull, row) for row in taken] for pull in pulls]
    y = solved(gram, [e - dot(pull, [wish[j] for j in free]) for e, pull in zip(twist, pulls, strict=True)])
    z = [Fraction(0)] * len(wish)
    pull = combined(p, y)
    for j in free:
        z[j] = (wish[j] + pull[j]) / p.hessian[j]
    return z, y


def broken(p: Exact, d: Vector, held: list[int]) -> tuple[int, int, Fraction] | None:
    """Joint most outside its bounds, the side to push it to, and how far; None where all are inside."""
    worst = None
    for j, value in enumerate(d):
        low, up = p.lower[j], p.upper[j]
        for side, excess in (
            (1, low - value if low is not None else 0),
            (-1, value - up if up is not None else 0),
        ):
            if j not in held and excess > (worst[2] if worst else 0):
                worst = j, side, excess
    return worst


def truth(p: Exact) -> Optimum | Contradiction:
    """Goldfarb and Idnani's dual method with the rows of J held throughout; ends, as nothing rounds."""
    n = len(p.gradient)
    d, k = moved(p, list(range(n)), [-g for g in p.gradient], p.twist)
    sides: dict[int, int] = {}
    sizes: dict[int, Fraction] = {}
    while (found := broken(p, d, list(sides))) is not None:
        joint, side, excess = found
        size = Fraction(0)
        normal = [Fraction(side if j == joint else 0) for j in range(n)]
        while True:
            way, turn = moved(p, [j for j in range(n) if j not in sides], normal, [Fraction(0)] * len(k))
            pull = combined(p, turn)
            falls = {j: s * pull[j] for j, s in sides.items() if s * pull[j] > 0}
            release = min(falls, key=lambda j: sizes[j] / falls[j], default=None)
            rate = side * way[joint]
            if not rate and release is None:
                return Contradiction(turn)
            to_release = sizes[release] / falls[release] if release is not None else None
            step = excess / rate if rate else to_release
            arrives = to_release is None or (rate and step <= to_release)
            step = step if arrives else to_release
            d = [a + step * b for a, b in zip(d, way, strict=True)]
            k = [a + step * b for a, b in zip(k, turn, strict=True)]
            sizes = {j: sizes[j] - step * s * pull[j] for j, s in sides.items()}
            size, excess = size + step, excess - step * rate
            if arrives:
                sides[joint], sizes[joint] = side, size
                break
            del sides[release], sizes[release]
    return Optimum(d, k, [sides.get(j, 0) * sizes.get(j, Fraction(0)) for j in range(n)])


def assert_certified(p: Exact, answer: Optimum | Contradiction) -> None:
    """Karush, Kuhn, Tucker for an optimum, Farkas for a contradiction: sufficient, and without rounding."""
    if isinstance(answer, Contradiction):
        reach = combined(p, answer.y)
        ends = [(p.lower[j], p.upper[j]) if c > 0 else (p.upper[j], p.lower[j]) for j, c in enumerate(reach)]
        asked = dot(answer.y, p.twist)
        outside = False
        for end, way in ((0, -1), (1, 1)):
            limits = [(c, pair[end]) for c, pair in zip(reach, ends, strict=True) if c]
            if all(limit is not None for _, limit in limits):
                outside |= way * (asked - sum(c * limit for c, limit in limits)) > 0
        assert outside
        return
    assert all(dot(row, answer.d) == e for row, e in zip(p.rows, p.twist, strict=True))
    pull = combined(p, answer.k)
    for j, value in enumerate(answer.d):
        low, up, push = p.lower[j], p.upper[j], answer.pushes[j]
        assert p.hessian[j] * value + p.gradient[j] == pull[j] + push
        assert low is None or value >= low
        assert up is None or value <= up
        assert push == 0 or value == (low if push > 0 else up)


def grid(values: np.ndarray, bits: int) -> np.ndarray:
    """Rounded to whole multiples of 2^-bits, so that products and sums of such numbers are exact."""
    return np.round(np.asarray(values) * 2.0**bits) / 2.0**bits


def drawn_rows(rng: np.random.Generator, m: int, n: int, kind: str) -> np.ndarray:
    rows = grid(rng.normal(size=(m, n)), 12)
    if kind == "zeros":
        while True:
            sparse = rows * (rng.random((m, n)) < 0.5)
            if np.linalg.svd(sparse, compute_uv=False)[-1] > 1e-3:
                return sparse
    if kind == "singular":
        # The last row is a combination of the others but for 1e-6 to 1e-2 of another one.
        rows[-1] = rng.normal(size=m - 1) @ rows[:-1] + 10.0 ** rng.uniform(-6.0, -2.0) * rows[-1]
    return rows


def drawn_hessian(rng: np.random.Generator, n: int, kind: str) -> np.ndarray:
    if kind == "scaled":
        return 10.0 ** rng.uniform(-3.0, 3.0, n)
    return rng.choice([np.arange(n, 0.0, -1.0), rng.uniform(0.1, 10.0, n), np.ones(n)])


def backwards(rng: np.random.Generator, rows: np.ndarray, hessian: np.ndarray, kind: str) -> StepProblem:
    """A problem made around its solution: 0 to n - m bounds hold it, more than that where they meet."""
    m, n = rows.shape
    d = grid(rng.choice([0.002, 0.02, 0.2]) * rng.normal(size=n), 24)
    if kind in {"zeros", "on limit"}:
        d = d * (rng.random(n) < 0.5)
    active = rng.permutation(n)[: rng.integers(0, n - m + 1)]
    side = rng.choice([-1.0, 1.0], n)
    push = np.zeros(n)
    push[active] = (side * hessian)[active] * np.abs(rng.normal(size=active.size)) * np.max(np.abs(d))
    if kind in {"weak", "residue"}:
        push *= rng.random(n) < 0.5
    touching = np.isin(np.arange(n), active)
    if kind in {"redundant", "residue"}:
        touching |= rng.random(n) < 0.5
    slack = grid(rng.choice([0.002, 0.02, 0.2]) * rng.uniform(0.05, 2.0, (2, n)), 24)
    if kind in {"zeros", "on limit"}:
        # A state on a limit: one bound of the step is an exact zero.
        slack = np.where((d == 0.0) & (rng.random((2, n)) < 0.5), 0.0, slack)
    below = np.where(touching & (side > 0.0), 0.0, slack[0])
    above = np.where(touching & (side < 0.0), 0.0, slack[1])
    if kind in {"pinned", "residue"}:
        both = rng.random(n) < rng.choice([0.2, 0.8])
        below, above = np.where(both, 0.0, below), np.where(both, 0.0, above)
    along_path = rows.T @ rng.normal(size=m) * rng.choice([0.0, np.min(hessian)])
    gradient = along_path + push - hessian * d
    lower, upper = d - below, d + above
    if kind == "open":
        lower = np.where(~touching & (rng.random(n) < 0.5), -np.inf, lower)
        upper = np.where(~touching & (rng.random(n) < 0.5), np.inf, upper)
    twist = rows @ d
    if kind == "residue":
        residues = 1e-16 * rng.normal(size=(2, n))
        lower, upper = lower + np.minimum(residues[0], 0.0), upper + np.maximum(residues[0], 0.0)
        shift = residues[1] * (rng.random(n) < 0.3)
        lower = np.minimum(lower + shift, upper)
        twist, gradient = twist + 1e-16 * rng.normal(size=m), gradient + 1e-16 * rng.normal(size=n)
    return StepProblem(rows, twist, gradient, hessian, lower, upper)


def forwards(rng: np.random.Generator, rows: np.ndarray, hessian: np.ndarray, kind: str) -> StepProblem:
    """A problem made from its parts: pull of the criterion, way of the path, room of the joints."""
    m, n = rows.shape
    gradient = hessian * rng.normal(size=n) * rng.choice([0.0, 1e-3, 0.1, 1.0], size=n)
    half = rng.choice([0.02, 0.2, 2.0]) * rng.choice([1.0, 1.0, 0.0, 1e-16, 10.0], size=n)
    inside = np.clip(rng.normal(size=n) * 0.3, -1.0, 1.0) * half
    low, up = np.minimum(-half * rng.choice([1.0, 0.5], size=n), inside), np.maximum(half, inside)
    twist = rows @ (inside * rng.choice([1.0, 1.0, 0.3, 1.5])) * rng.choice([1.0, 1.0, 0.0])
    if kind == "touching":
        inverse = 1.0 / hessian
        k = np.linalg.solve((rows * inverse) @ rows.T, twist + rows @ (inverse * gradient))
        least = inverse * (rows.T @ k - gradient)
        low, up = np.minimum(least, least - half), np.maximum(least, least + half)
        low, up = (np.where(rng.random(n) < 0.3, least, bound) for bound in (low, up))
        cut = (rng.random(n) < 0.2) & (low < least)
        up = np.where(cut, least - 0.1 * (least - low), up)
    if kind == "infeasible":
        # Some combination of the path's rows asks for more than all joints at their bounds can give.
        y = rng.normal(size=m) * (rng.random(m) < 0.7) + np.eye(m)[rng.integers(m)]
        reach = rows.T @ y
        most = np.sum(np.maximum(reach * low, reach * up))
        twist = twist + y / (y @ y) * (most + 10.0 ** rng.uniform(-6.0, 0.0) - y @ twist)
    return StepProblem(rows, twist, gradient, hessian, low, up)


def drawn(seed: int) -> tuple[StepProblem, str]:
    """A problem of 3 to 12 joints and 2 to 6 rows, and its kind; the kinds follow each other."""
    rng = np.random.default_rng([1603, seed])
    kind, n = KINDS[seed % len(KINDS)], int(rng.integers(3, 13))
    m = int(rng.integers(2, min(6, n - 1) + 1))
    rows, hessian = drawn_rows(rng, m, n, kind), drawn_hessian(rng, n, kind)
    ahead = kind in {"forward", "touching", "infeasible"} or (
        kind in {"scaled", "singular"} and rng.random() < 0.5
    )
    return (forwards if ahead else backwards)(rng, rows, hessian, kind), kind


def compact(problem: StepProblem, solver: ProxQpSolver) -> np.ndarray | None:
    """The step as a tick takes it; its solver keeps its workspaces from step to step."""
    d_free = free_step(problem)
    if within(d_free, problem.lower, problem.upper):
        return d_free
    step = bounded_step(problem, d_free, solver)
    return None if step is None else step.d


def promised(problem: StepProblem) -> float:
    """1e-9 max(1, cond(N'HN) / 1e6), N from a singular value decomposition."""
    null_space = np.linalg.svd(problem.jacobian)[2][len(problem.twist) :].T
    return ACCURACY * max(1.0, float(np.linalg.cond((null_space.T * problem.hessian) @ null_space)) / 1e6)


def judged(seed: int, solver: ProxQpSolver) -> tuple[str, str, float]:
    """Kind of a problem, outcome (`step`, `none`, `brink`), and the largest error of a joint's step."""
    problem, kind = drawn(seed)
    n, m = problem.hessian.size, problem.twist.size
    where = f"seed {seed}, {kind}, n {n}, m {m}"
    try:
        found = compact(problem, solver)
    except ArithmeticError as error:
        raise AssertionError(f"{where}: {error}") from error
    written_out = exact(problem)
    wanted = truth(written_out)
    assert_certified(written_out, wanted)
    if isinstance(wanted, Contradiction):
        if found is None:
            return kind, "none", 0.0
        assert isinstance(truth(exact(problem, BRINK)), Optimum), f"{where}: a step where there is none"
        left = float(np.max(np.abs(problem.jacobian @ found - problem.twist)))
        assert left < ACCURACY, f"{where}: {left:.3g} off the path"
        assert within(found, problem.lower - QP_EXCESS, problem.upper + QP_EXCESS), f"{where}: out of bounds"
        return kind, "brink", 0.0
    if found is None:
        room = np.all(problem.upper - problem.lower >= 2.0 * BRINK)
        narrowed = truth(exact(problem, -BRINK)) if room else None
        assert not isinstance(narrowed, Optimum), f"{where}: no step where there is one"
        return kind, "brink", 0.0
    error = max(abs(float(Fraction(a) - b)) for a, b in zip(found.tolist(), wanted.d, strict=True))
    limit = promised(problem)
    assert error <= limit, f"{where}: {error:.3g} from the optimum, allowed {limit:.3g}"
    return kind, "step", error / limit


def campaign(seeds: range) -> Counter[tuple[str, str]]:
    """All problems of some seeds; prints what came out, returns how often each kind had each outcome."""
    started, solver = perf_counter(), ProxQpSolver()
    outcomes: Counter[tuple[str, str]] = Counter()
    worst: dict[str, tuple[float, int]] = {}
    faults = []
    for seed in seeds:
        try:
            kind, outcome, error = judged(seed, solver)
        except AssertionError as fault:
            faults.append(str(fault).splitlines()[0])
            continue
        outcomes[kind, outcome] += 1
        worst[kind] = max(worst.get(kind, (0.0, seed)), (error, seed))
    print(f"seeds {seeds.start} to {seeds.stop - 1}: {perf_counter() - started:.1f} s")
    for kind in KINDS:
        counts = ", ".join(f"{outcomes[kind, end]} {end}" for end in ("step", "none", "brink"))
        size, seed = worst[kind]
        print(f"  {kind}: {counts}; worst error {size:.2g} of what is promised (seed {seed})")
    assert not faults, "\n".join(faults)
    return outcomes


def assert_mixed(outcomes: Counter[tuple[str, str]]) -> None:
    """Few problems may be open to both answers, and each answer must be asked for often enough."""
    total = sum(outcomes.values())
    ends = {end: sum(outcomes[kind, end] for kind in KINDS) for end in ("step", "none", "brink")}
    assert ends["step"] > 0.7 * total
    assert ends["none"] > 0.05 * total
    assert ends["brink"] < 0.1 * total
    assert all(outcomes[kind, "step"] > 0 for kind in KINDS if kind != "infeasible")


def test_compact_step_is_the_optimum_of_the_full_problem() -> None:
    assert_mixed(campaign(range(QUICK)))


@pytest.mark.parametrize("seed", ONCE_WRONG)
def test_what_was_once_wrong(seed: int) -> None:
    assert judged(seed, ProxQpSolver())


@pytest.mark.slow
@pytest.mark.parametrize("first", range(QUICK, QUICK + LONG, PORTION))
def test_long_campaign(first: int) -> None:
    assert_mixed(campaign(range(first, first + PORTION)))
