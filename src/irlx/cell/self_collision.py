"""Which links of a cell's robot are kept off each other."""

from __future__ import annotations

from pathlib import Path

from irlx.cell.findings import Findings
from irlx.cell.link_meshes import mesh_faults
from irlx.cell.schema import RobotSection, SelfCollisionSection
from irlx.diagnostics import Diagnostic, told_apart
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.whole_file import whole_text
from irlx.robot.description import RobotDescription
from irlx.robot.link_pairs import pairs_that_could_meet
from irlx.robot.srdf import LinkPairs, pairs_that_may_touch
from irlx.robot.urdf_values import RobotModelError
from irlx.scene.scene import LinkClearance


def link_clearance(
    section: RobotSection,
    robot: RobotDescription,
    file: str,
    errors: list[Diagnostic],
    warnings: list[Diagnostic],
    *,
    asked: bool,
) -> LinkClearance | None:
    """Pairs of links to be watched, None for none.

    `asked`: whether the cell itself has `[robot.self_collision]`, not only the robot that it names. Then
    what is missing is an error: IRL633, IRL639, IRL641, IRL643, IRL644; else IRL645 warns.
    """
    given = section.self_collision
    active = bool(given.model_fields_set) if given.active is None else given.active
    findings = Findings(file, "robot.self_collision", errors, warnings)
    listed = _listed_pairs(given, robot, findings)
    if given.margin > given.influence:
        margin, influence = told_apart(given.margin, given.influence)
        findings.error("IRL633", "margin", margin=margin, influence=influence)
    if not active:
        return None
    lacking = mesh_faults(robot, section.model or "", file)
    described, cause = _described_pairs(given, robot, file)
    if asked:
        errors += lacking
        if cause:
            findings.error("IRL644", "srdf", file=given.srdf, cause=cause)
    elif lacking or cause:
        findings.warning("IRL645", cause=cause or lacking[0].message)
        return None
    may_touch = listed | described
    pairs = tuple(pair for pair in pairs_that_could_meet(robot) if frozenset(pair) not in may_touch)
    return LinkClearance(pairs, given.margin * 1e-3, given.influence * 1e-3) if pairs else None


def _listed_pairs(given: SelfCollisionSection, robot: RobotDescription, findings: Findings) -> LinkPairs:
    """Pairs of `may_touch`. Names that no link has go to `findings`, IRL643."""
    links = _links(robot)
    for number, pair in enumerate(given.may_touch, 1):
        for name in pair:
            if name not in links:
                near, known = near_matches(name, links), ", ".join(links)
                findings.error("IRL643", f"may_touch[{number}]", name=name, near=near, known=known)
    return frozenset(frozenset(pair) for pair in given.may_touch)


def _described_pairs(
    given: SelfCollisionSection, robot: RobotDescription, file: str
) -> tuple[LinkPairs, str]:
    """Pairs of the SRDF if one is given, and why it cannot be used, or ''."""
    if given.srdf is None:
        return frozenset(), ""
    path = Path(file).parent / given.srdf
    try:
        return pairs_that_may_touch(whole_text(path), _links(robot)), ""
    except FileNotFoundError:
        return frozenset(), f"there is no {path}"
    except OSError as cause:
        return frozenset(), cause.strerror or str(cause)
    except (RobotModelError, UnicodeDecodeError, ValueError) as cause:
        return frozenset(), str(cause)


def _links(robot: RobotDescription) -> tuple[str, ...]:
    return (robot.root, *(joint.child for joint in robot.joints))
