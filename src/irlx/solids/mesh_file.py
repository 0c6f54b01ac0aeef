"""Mesh files -> surfaces of triangles."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import cache, lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics.whole_file import whole_file
from irlx.solids.shape import Mesh
from irlx.solids.triangles import Triangles

Read = TypeVar("Read")

_TRIMESH = {"trimesh": "trimesh"}
_READERS = {
    "stl": _TRIMESH,
    "obj": _TRIMESH,
    "ply": _TRIMESH,
    "dae": {**_TRIMESH, "collada": "pycollada"},
}
"""Endings of the mesh files that are read, and the modules that read them with the packages they are in."""
_STL_HEAD = 84
_STL_FACE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""A binary STL file: 80 bytes, the number of faces in 4 more, then the faces."""
_SAME = 1e-7
"""Vertices nearer than this share of a mesh's extent are one; files repeat them for every face."""
_FLAT = 1e-12
"""Share of the volume of its bounding box that a surface has to enclose."""
_FARTHEST = 1e12
"""Coordinates of a mesh file lie below; beyond, squares and products of them say nothing."""
_KEPT = 256
_MOST_BYTES = 256_000_000
"""Of a mesh file."""
_QUIET = logging.NullHandler()


class MeshFileError(ValueError):
    """A mesh file that cannot be used; its text is the `reason`, without the file's name."""

    @property
    def reason(self) -> str:
        """What is wrong with the file."""
        return str(self)


class MeshReaderMissing(MeshFileError):
    """A package that reads the mesh file is not installed."""


def read_mesh(mesh: Mesh) -> Triangles:
    """Surface in the file of a mesh, in m: its vertices times `mesh.scale`, whether closed or not.

    Vertices at the same place are joined, faces without area dropped. A scale that mirrors turns the faces
    around. The unit that a COLLADA file states counts, its upward axis does not, as for ROS. Read once a
    process while the file stays as it is. Raises MeshFileError: no such file, unreadable, empty, a
    format that is not known; MeshReaderMissing without the extra `meshes`, which binary STL does not need.
    """
    return _read(mesh, *state_of(Path(mesh.file)))


def state_of(path: Path) -> tuple[int, int]:
    """Time of change (ns) and size of a mesh file. Raises MeshFileError: not there, or no format known."""
    if path.suffix[1:].lower() not in _READERS:
        raise MeshFileError(f"'{path.suffix}' is no format of meshes that irlx reads: {', '.join(_READERS)}")
    try:
        state = path.stat()
    except (OSError, ValueError) as cause:
        raise MeshFileError(_words(cause)) from cause
    return state.st_mtime_ns, state.st_size


def read_closed_mesh(mesh: Mesh) -> Triangles:
    """Surface of a mesh file that bounds a body: closed, and its faces look outwards.

    Raises MeshFileError as `read_mesh` does, and for a surface that is open, turned inside out or flat.
    """
    found = read_mesh(mesh)
    if found.open_edges:
        raise MeshFileError(
            f"its surface is not closed: {found.open_edges} edges without a matching face on the other side"
        )
    box = float(np.prod(np.ptp(found.vertices, axis=0)))
    if abs(found.volume) <= _FLAT * box or box == 0.0:
        raise MeshFileError("its surface encloses no volume")
    if found.volume < 0.0:
        raise MeshFileError("its faces look inwards")
    return found


@lru_cache(maxsize=_KEPT)
def _read(mesh: Mesh, modified: int, size: int) -> Triangles:
    """`read_mesh`; time of change (ns) and size tell a file that was written anew."""
    vertices, faces = joined(*_content(Path(mesh.file)))
    if len(faces) == 0:
        raise MeshFileError("it holds no triangles")
    found = scaled(vertices, faces, mesh)
    for array in (found.vertices, found.faces):
        array.setflags(write=False)
    return found


def scaled(vertices: NDArray[np.float64], faces: NDArray[np.int64], mesh: Mesh) -> Triangles:
    """Surface of vertices (V, 3) and faces (F, 3) of a mesh's file at the scale of the mesh, faces outwards.

    Raises MeshFileError for a scale at which coordinates are no lengths.
    """
    scale = np.array(mesh.scale)
    with np.errstate(over="ignore"):
        points = vertices * scale
    if not np.all(np.abs(points) < _FARTHEST):
        raise MeshFileError("its scale makes coordinates of it that are no lengths")
    # Signs are counted: a product of three factors may be out of range where each of them is in it.
    mirrors = np.count_nonzero(scale < 0.0) % 2 == 1
    return Triangles(points, faces[:, ::-1] if mirrors else faces)


def missing_package(mesh: Mesh) -> str:
    """The package that reads a mesh file and is not installed, or ''; also for a file that cannot be read.

    Binary STL files need none.
    """
    path = Path(mesh.file)
    needed = _READERS.get(path.suffix[1:].lower(), {})
    lacking = next((package for module, package in needed.items() if not _is_installed(module)), "")
    return "" if lacking and _is_binary_stl(path) else lacking


@cache
def _is_installed(module: str) -> bool:
    return find_spec(module) is not None


def _is_binary_stl(path: Path) -> bool:
    """Whether a file is an STL file as long as the number of faces in its head says."""
    if path.suffix.lower() != ".stl":
        return False
    try:
        with path.open("rb") as file:
            head = file.read(_STL_HEAD)
        size = path.stat().st_size
    except OSError:
        return False
    return size == _STL_HEAD + _STL_FACE.itemsize * int.from_bytes(head[80:], "little")


def _content(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces as the file has them. Raises MeshFileError."""
    try:
        content = whole_file(path, _MOST_BYTES)
    except OSError as cause:
        raise MeshFileError(_words(cause)) from cause
    if not content.strip():
        raise MeshFileError("it is empty")
    if _is_binary_stl(path):
        # Read here: most meshes of robots are such files, and to import trimesh takes longer than they do.
        corners = np.frombuffer(content, _STL_FACE, offset=_STL_HEAD)["corners"]
        with np.errstate(invalid="ignore"):
            vertices = corners.reshape(-1, 3).astype(float)
        return vertices, np.arange(len(vertices)).reshape(-1, 3)
    if path.suffix.lower() == ".stl" and not content.lstrip().lower().startswith(b"solid"):
        # Neither binary nor text; some versions of trimesh find nothing wrong with that.
        raise MeshFileError("it is no whole STL file")
    return arrays_of(read_with_trimesh(path, _as_one_mesh))


def arrays_of(loaded: Any) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (V, 3) and faces (F, 3) of a mesh of trimesh. Raises MeshFileError."""
    vertices = np.array(loaded.vertices, dtype=float)
    faces = np.array(loaded.faces, dtype=np.int64)
    if vertices.size and vertices.shape[1:] != (3,):
        raise MeshFileError("it holds vertices that have no three coordinates")
    if faces.size and faces.shape[1:] != (3,):
        raise MeshFileError("it holds faces that are no triangles")
    vertices, faces = vertices.reshape(-1, 3), faces.reshape(-1, 3)
    if len(faces) and not (faces.min() >= 0 and faces.max() < len(vertices)):
        raise MeshFileError("it names vertices that it does not hold")
    return vertices, faces


def _as_one_mesh(path: Path) -> Any:
    """One mesh of all that a file holds, in m."""
    import trimesh

    loaded = trimesh.load_mesh(str(path), process=False)
    return loaded.convert_units("meters") if path.suffix.lower() == ".dae" else loaded


def read_with_trimesh(path: Path, reader: Callable[[Path], Read]) -> Read:
    """What `reader` makes of a file with the library trimesh. Raises MeshFileError."""
    ending = path.suffix[1:].lower()
    for module, package in _READERS[ending].items():
        try:
            import_module(module)
        except ImportError as cause:
            raise MeshReaderMissing(f"the package {package} is not installed") from cause
    # Of what is broken it logs a traceback, which without any handler would come up on the terminal.
    logging.getLogger("trimesh").addHandler(_QUIET)
    try:
        return reader(path)
    except Exception as cause:
        # A broken file makes the readers of the formats fail in ways of their own: index, key, struct, XML.
        detail = "" if isinstance(cause, ImportError) else f" ({_words(cause)})"
        raise MeshFileError(f"it is no whole {ending.upper()} file{detail}") from cause


def joined(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The mesh with one vertex at a place, only those that faces use, and without faces that have no area.

    Raises MeshFileError for coordinates that are no lengths.
    """
    if not np.all(np.abs(vertices) < _FARTHEST):
        raise MeshFileError("it holds coordinates that are no lengths")
    used = vertices[faces.ravel()]
    if not len(used):
        return vertices, faces
    extent = float(np.max(np.ptp(used, axis=0)))
    cells = np.round((used - used.min(axis=0)) / (_SAME * extent if extent > 0.0 else 1.0))
    # The same as np.unique along an axis, several times faster: sorted, equal cells lie beside each other.
    order = np.lexsort(cells.T)
    new = np.append(True, np.any(np.diff(cells[order], axis=0) != 0.0, axis=1))
    which = np.empty(len(cells), dtype=np.int64)
    which[order] = np.cumsum(new) - 1
    corners, first = which.reshape(-1, 3), order[new]
    a, b, c = corners.T
    return used[first], corners[(a != b) & (b != c) & (c != a)].astype(np.int64)


def _words(cause: BaseException) -> str:
    """First line of what an exception says."""
    text = (cause.strerror or "") if isinstance(cause, OSError) else str(cause)
    return next(iter(text.splitlines()), "") or type(cause).__name__
