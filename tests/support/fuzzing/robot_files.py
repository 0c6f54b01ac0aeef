"""A robot with everything that a URDF may say, and the files beside it."""

from __future__ import annotations

from pathlib import Path

from fuzzing.xml_damage import SECRET
from mesh_files import CUBE, TRIANGLES, WRITERS

_JOINTS = (
    (
        "rail",
        "prismatic",
        "base",
        "carriage",
        "0 0 0.1",
        "1 0 0",
        'lower="-1" upper="1" velocity="2" effort="9"',
    ),
    (
        "shoulder",
        "revolute",
        "carriage",
        "shoulder_link",
        "0 0 0.3",
        "0 0 1",
        'lower="-3" upper="3" velocity="2"',
    ),
    ("arm", "revolute", "shoulder_link", "arm_link", "0 0 0.2", "0 1 0", 'lower="-2" upper="2" velocity="2"'),
    (
        "elbow",
        "revolute",
        "arm_link",
        "elbow_link",
        "0 0 0.4",
        "0 1 0",
        'lower="-2.5" upper="2.5" velocity="2"',
    ),
    ("roll", "continuous", "elbow_link", "roll_link", "0 0 0.2", "0 0 1", 'velocity="3" effort="1"'),
    ("wrist", "revolute", "roll_link", "wrist_link", "0 0 0.2", "0 1 0", 'lower="-2" upper="2" velocity="3"'),
    (
        "flange",
        "revolute",
        "wrist_link",
        "flange_link",
        "0 0 0.1",
        "0 0 1",
        'lower="-6" upper="6" velocity="3"',
    ),
    ("mount", "fixed", "flange_link", "tool", "0 0 0.1", "1 0 0", ""),
    (
        "finger",
        "prismatic",
        "flange_link",
        "finger_link",
        "0.02 0 0.1",
        "1 0 0",
        'lower="0" upper="0.04" velocity="1"',
    ),
)
_SHAPES = (
    '<box size="0.1 0.1 0.1"/>',
    '<cylinder radius="0.03" length="0.2"/>',
    '<sphere radius="0.04"/>',
    '<capsule radius="0.03" length="0.1"/>',
    '<mesh filename="package://any/meshes/cube.stl" scale="0.05 0.05 0.05"/>',
    '<mesh filename="cube.obj" scale="0.02 0.02 0.02"/>',
    '<mesh filename="cube.ply" scale="0.02 0.02 0.02"/>',
    '<mesh filename="cube.dae" scale="0.02 0.02 0.02"/>',
)
SRDF = """<?xml version="1.0"?>
<robot name="full">
  <group name="arm"><chain base_link="base" tip_link="tool"/></group>
  <disable_collisions link1="base" link2="carriage" reason="Adjacent"/>
  <disable_collisions link1="base" link2="shoulder_link" reason="Never"/>
  <disable_default_collisions link="finger_link"/>
  <enable_collisions link1="finger_link" link2="base"/>
</robot>
"""


def _link(name: str, number: int) -> str:
    shape = _SHAPES[number % len(_SHAPES)]
    place = '<origin xyz="0 0 0.02" rpy="0 0 0.1"/>'
    mass = (
        f'<inertial>{place}<mass value="1.5"/>'
        '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
    )
    material = (
        '<material name="red"/>'
        if number % 2
        else '<material name="own"><color rgba="0 1 0 0.5"/></material>'
    )
    visual = f"<visual>{place}<geometry>{shape}</geometry>{material}</visual>"
    collision = f"<collision><geometry>{shape}</geometry></collision>"
    return f'  <link name="{name}">\n    {mass}\n    {visual}\n    {collision}\n  </link>\n'


def _joint(name: str, kind: str, parent: str, child: str, xyz: str, axis: str, limit: str) -> str:
    limits = f"<limit {limit}/>" if limit else ""
    mimic = '<mimic joint="rail" multiplier="0.01" offset="0.005"/>' if name == "finger" else ""
    lines = (
        f'<joint name="{name}" type="{kind}">',
        f'<origin xyz="{xyz}" rpy="0 0 0"/>',
        f'<parent link="{parent}"/>',
        f'<child link="{child}"/>',
        f'<axis xyz="{axis}"/>',
        f'{limits}{mimic}<dynamics damping="0.1"/>',
        "</joint>\n",
    )
    return "\n".join(lines)


FULL_ROBOT = (
    '<?xml version="1.0"?>\n<robot name="full">\n  <material name="red"><color rgba="1 0 0 1"/></material>\n'
    + _link("base", 0)
    + "".join(_link(joint[3], number) for number, joint in enumerate(_JOINTS, 1))
    + "".join(_joint(*joint) for joint in _JOINTS)
    + "</robot>\n"
)


def put_beside(folder: Path) -> None:
    """Write the robot, its SRDF, its meshes, and a file with a secret that is none of theirs."""
    (folder / "robot.urdf").write_text(FULL_ROBOT, encoding="utf-8")
    (folder / "robot.srdf").write_text(SRDF, encoding="utf-8")
    (folder / "secret.txt").write_text(SECRET, encoding="utf-8")
    (folder / "secret.stl").write_text(f"solid {SECRET}\nendsolid\n", encoding="utf-8")
    (folder / "meshes").mkdir(exist_ok=True)
    for ending, write in WRITERS.items():
        for place in (folder, folder / "meshes"):
            (place / f"cube.{ending}").write_bytes(write(CUBE, TRIANGLES))
