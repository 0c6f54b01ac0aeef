"""Robots (URDF), pairs of links that may touch (SRDF), and meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from random import Random

import numpy as np

from fuzzing.byte_damage import BINARY, TEXT, damaged
from fuzzing.case import Fault
from fuzzing.cell_readers import used
from fuzzing.known_texts import ROOT
from fuzzing.reader import Reader
from fuzzing.robot_files import FULL_ROBOT, SRDF, put_beside
from fuzzing.xml_damage import HEADS, SECRET, damaged_xml, with_head
from irlx.cell.errors import CellError
from irlx.cell.load import load_cell
from irlx.cell.robot_check.check import check_robot
from irlx.diagnostics import Diagnostic, Place, report
from irlx.report.appearance.build import appearance_of
from irlx.robot.srdf import pairs_that_may_touch
from irlx.robot.urdf_values import RobotModelError
from irlx.solids.hull import hull_of
from irlx.solids.mesh_file import MeshFileError, read_closed_mesh, read_mesh
from irlx.solids.painted_mesh import read_painted_mesh
from irlx.solids.shape import Mesh
from mesh_files import CUBE, QUADS, TRIANGLES, WRITERS

_NOWHERE = Place("cell.toml", key="robot.model")
_PLAIN = '[robot]\nmodel = "robot.urdf"\n'
_FULL = (
    _PLAIN
    + 'tip = "tool"\n[robot.self_collision]\nactive = true\n[[obstacle]]\nname = "wall"\nshape = "box"\n'
    "size = [20, 1000, 150]\nxyz = [2880, 0, 75]\n"
)


class UrdfReader(Reader):
    """URDF files with the meshes that they name."""

    kind = "urdf"
    ending = ".urdf"
    share = 4.0

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        put_beside(folder)
        self._path = folder / "robot.urdf"
        self._cells = (folder / "plain.toml", folder / "full.toml")
        for path, text in zip(self._cells, (_PLAIN, _FULL), strict=True):
            path.write_text(text, encoding="utf-8")

    def made(self) -> list[bytes]:
        packaged = sorted((ROOT / "src" / "irlx" / "cell" / "robots").glob("*.urdf"))
        texts = [path.read_text(encoding="utf-8") for path in packaged]
        texts = [FULL_ROBOT, *(text for text in texts if len(text) < 9000)]
        return [text.encode() for text in (*texts, FULL_ROBOT, FULL_ROBOT)]

    def systematic(self) -> Iterable[Callable[[], bytes]]:
        body = FULL_ROBOT.partition("?>")[2]
        return [
            lambda head=head, seed=seed: with_head(body, head, Random(seed)).encode()
            for head in HEADS
            for seed in range(4)
        ]

    def damaged(self, content: bytes, chance: Random) -> bytes:
        return damaged_xml(content, chance)

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        self._path.write_bytes(content)
        try:
            told = check_robot(self._path)
        except CellError as error:
            told = list(error.diagnostics)
        usable = not any(one.is_error for one in told)
        accepted = False
        for number, path in enumerate(self._cells):
            try:
                cell = load_cell(path)
                if SECRET in repr(cell.robot):
                    raise Fault("a robot holds what stands in another file")
                used(cell)
            except CellError as error:
                found = list(error.diagnostics)
                if (
                    number == 0
                    and usable
                    and found[0].code == "IRL612"
                    and "say which one is the tip" not in str(found[0])
                ):
                    raise Fault("a robot that is found usable is none", "", str(found[0])) from error
                told += found
            else:
                if not usable:
                    raise Fault("a robot that is found unusable is used", "", str(told[0]))
                accepted = True
                told += cell.warnings
                if thorough:
                    told += appearance_of(cell).robot.diagnostics
        return accepted, [one for one in told if not (accepted and one.is_error)]


class SrdfReader(Reader):
    """SRDF files."""

    kind = "srdf"
    ending = ".srdf"
    share = 0.3

    def made(self) -> list[bytes]:
        return [SRDF.encode()]

    def damaged(self, content: bytes, chance: Random) -> bytes:
        return damaged_xml(content, chance)

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        links = ("base", "carriage", "shoulder_link", "finger_link")
        try:
            text = content.decode("utf-8")
        except UnicodeDecodeError:
            return False, [_refused("no UTF-8")]
        try:
            pairs = pairs_that_may_touch(text, links)
        except RobotModelError as error:
            return False, [_refused(str(error))]
        if any(not pair <= set(links) for pair in pairs):
            raise Fault("a link that there is not may touch", self.kind)
        return True, []


class MeshReader(Reader):
    """Mesh files of one format; what is accepted is a surface of finite triangles."""

    share = 0.7

    def __init__(self, folder: Path, ending: str) -> None:
        super().__init__(folder)
        self.kind, self.ending = f"mesh-{ending}", f".{ending}"
        self._number = 0

    def made(self) -> list[bytes]:
        write = WRITERS[self.ending[1:]]
        tall = CUBE * np.array([1.0, 2.0, 30.0])
        found = [write(CUBE, TRIANGLES), write(tall, TRIANGLES[:-1])]
        if self.ending == ".stl":
            found.append(_text_stl())
        if self.ending == ".obj":
            found.append(
                b"mtllib secret.txt\nusemtl red\n"
                + write(CUBE, QUADS)
                + b"vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n"
            )
        return found

    def damaged(self, content: bytes, chance: Random) -> bytes:
        if self.ending == ".dae" and chance.random() < 0.7:
            return damaged_xml(content, chance)
        binary = self.ending == ".stl" and not content.startswith(b"solid")
        return damaged(content, chance, BINARY if binary else TEXT)

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        # One of the same name and size, written within a tick of the file system, would count as read.
        self._number += 1
        path = self.folder / f"m{self._number}{self.ending}"
        path.write_bytes(content)
        try:
            return self._surfaces(Mesh(str(path), (0.001, 1.0, -1.0)))
        finally:
            path.unlink()

    def _surfaces(self, mesh: Mesh) -> tuple[bool, list[Diagnostic]]:
        refused: list[Diagnostic] = []
        for read in (read_mesh, read_closed_mesh, read_painted_mesh, lambda mesh: hull_of(read_mesh(mesh))):
            try:
                found = read(mesh)
            except MeshFileError as error:
                refused.append(_refused(error.reason))
                continue
            surfaces = [one.surface for one in found] if isinstance(found, tuple | list) else [found]
            for one in surfaces:
                if not np.all(np.isfinite(one.vertices)):
                    raise Fault("an accepted mesh holds numbers that are none", self.kind)
        return (True, []) if len(refused) < 4 else (False, refused)


def _refused(words: str) -> Diagnostic:
    """What a cell would tell of it."""
    if "\n" in words or not words:
        raise Fault("words that are for nobody", "", repr(words))
    return report("IRL640", key="x", file="m", cause=words, place=_NOWHERE)


def _text_stl() -> bytes:
    lines = ["solid cube"]
    for face in TRIANGLES:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y, z in CUBE[list(face)]]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid cube", ""]).encode()
