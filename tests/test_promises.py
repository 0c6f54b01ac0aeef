"""Every promised number is written where people read it, with the value that the code holds to."""

import re
from pathlib import Path

import numpy as np
import pytest

from irlx import promises

ROOT = Path(__file__).parents[1]
CONSTANTS = {name: value for name, value in vars(promises).items() if name.isupper()}
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?e-\d+")


def rows_of(page: Path, heading: str) -> list[list[str]]:
    """Cells of the table under a header line that begins with `heading`."""
    lines = page.read_text(encoding="utf-8").splitlines()
    start = next(number for number, line in enumerate(lines) if line.startswith(heading))
    found = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        found.append([cell.strip() for cell in line.strip("|").split("|")])
    return found


def test_the_readme_says_the_numbers_of_the_module():
    cited = set()
    for promise, number, names, _ in rows_of(ROOT / "README.md", "| promise |"):
        said = {float(text) for text in NUMBER.findall(number)}
        held = {CONSTANTS[name] for name in re.findall(r"`([A-Z_]+)`", names)}
        # A step of 1e-9 at either end makes 2e-9.
        assert {value if value in held else value / 2.0 for value in said} == held, promise
        cited |= set(re.findall(r"`([A-Z_]+)`", names))
    assert {"PATH_POSITION", "PATH_ORIENTATION", "LIMIT_EXCESS", "CLOSURE"} <= cited


def test_every_tolerance_is_told_with_its_check():
    page = (ROOT / "docs" / "reference" / "verifier.md").read_text(encoding="utf-8")
    assert {name for name in CONSTANTS if f"`{name}`" not in page} == set()


def test_no_check_has_a_tolerance_of_its_own():
    """The verifier's modules name no small number but those that tell cases apart, or end an iteration."""
    told_apart = {
        "arcs.py": 3,
        "paths.py": 5,
        "task_turns.py": 1,
        "chain_legs.py": 1,
        "blends.py": 2,
        "attitudes.py": 1,
    }
    told_apart |= {"crossing_ptps.py": 1}
    ends_of_iterations = {"allowance.py": 4, "bernstein.py": 1, "corners.py": 3, "splines.py": 1}
    of_distances = {
        "depth.py": 1,
        "mesh_pairs.py": 1,
        "search.py": 1,
        "separation.py": 3,
        "simplex.py": 1,
        "sphere_tree.py": 2,
    }
    found = {}
    for path in sorted((ROOT / "src" / "irlx" / "verifier").rglob("*.py")):
        numbers = NUMBER.findall(re.sub(r'"""(?:.|\n)*?"""', "", path.read_text(encoding="utf-8")))
        if numbers:
            found[path.name] = len(numbers)
    assert found == told_apart | ends_of_iterations | of_distances


@pytest.mark.parametrize("largest", [0.0, 1e-300, 1.0, np.pi, 4.0, 1e6])
def test_the_rounding_allowance_covers_what_storing_does(largest):
    """Differences of rounded values against those of the exact ones, at the worst that rounding can do."""
    dt = 0.001
    unit = np.spacing(largest)
    speed, acceleration = promises.rounding_allowance(np.array([[0.0, -largest]]), dt)
    assert speed == 2.0 * unit / dt
    assert acceleration == 4.0 * unit / dt**2
    # Each stored value is off by half a unit at most: two of them in a difference, 1 + 2 + 1 in a second one.
    assert speed >= (0.5 + 0.5) * unit / dt
    assert acceleration >= (0.5 + 1.0 + 0.5) * unit / dt**2
