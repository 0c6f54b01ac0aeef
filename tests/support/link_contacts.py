"""Which links of a robot touch: at its start, and how often in postures drawn within its limits.

``python tests/support/link_contacts.py arm7 [POSTURES]`` prints every pair of links with solids that an axis
moves against each other and that are no neighbours: the least distance and that at the start (mm), and the
share of postures nearer than 5 mm. What is near always, or at the start, touches by construction and belongs
into `may_touch`. -9999 stands for solids that lie deep in each other.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_pairs import pairs_that_could_meet
from irlx.scene.distances import Distances
from irlx.scene.scene import LinkClearance
from irlx.scene.watched_pair import watched_pairs

NEAR = 0.005
"""Distance (m) that counts as contact: the margin by default."""


def distances_of(cell, pairs, postures):
    """Distance (m) of each pair of links, the least over their solids, in each posture: (P, N)."""
    kinematics = Kinematics(cell.robot)
    watched = watched_pairs(kinematics, (), LinkClearance(pairs, 0.0, 1.0))
    distances = Distances(kinematics, watched)
    all_of_them = np.arange(len(watched))
    number = {pair: k for k, pair in enumerate(pairs)}
    which = [number[one.link, one.other] for one in watched]
    found = np.full((len(pairs), len(postures)), np.inf)
    for column, q in enumerate(postures):
        np.minimum.at(found[:, column], which, distances.of(q, all_of_them).distance)
    # The library gives the lowest number there is where it does not find how deep two solids overlap.
    return np.maximum(found, -9.999)


def drawn_postures(cell, count, seed=0):
    """Postures (N, n) drawn evenly within the position limits; without any, half a turn or 1 m each way."""
    slides = np.array([axis.is_prismatic for axis in cell.robot.axes])
    far = np.where(slides, 1.0, np.pi)
    lower = np.where(np.isfinite(cell.limits.position_lower), cell.limits.position_lower, -far)
    upper = np.where(np.isfinite(cell.limits.position_upper), cell.limits.position_upper, far)
    return np.random.default_rng(seed).uniform(lower, upper, (count, len(slides)))


def cell_of(name):
    """The cell of a robot by name, as it is by itself."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        path.write_text(f'[robot]\nmodel = "{name}"\n', encoding="utf-8")
        return load_cell(path)


def main(name, count=2000):
    cell = cell_of(name)
    pairs = pairs_that_could_meet(cell.robot)
    watched = set(cell.scene.links.pairs if cell.scene.links else ())
    start = distances_of(cell, pairs, cell.start[None])[:, 0]
    drawn = distances_of(cell, pairs, drawn_postures(cell, int(count)))
    for k in np.argsort(-np.mean(drawn < NEAR, axis=1)):
        least, share = np.min(drawn[k]), np.mean(drawn[k] < NEAR)
        kept = "watched" if pairs[k] in watched else ""
        line = f"least {least * 1e3:9.1f}, start {start[k] * 1e3:9.1f} mm, near in {share:6.1%}"
        print(f"{pairs[k][0]:>28} {pairs[k][1]:<28} {line} {kept}")


if __name__ == "__main__":
    main(*sys.argv[1:])
