"""Meshes written to files by hand, so that no reader of irlx or of a library has made them."""

import struct

import numpy as np

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
"""The six faces of the cube, counterclockwise seen from outside."""
TRIANGLES = [face for a, b, c, d in QUADS for face in ((a, b, c), (a, c, d))]


def obj(vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, dtype=float).tolist()]
    return "\n".join([*lines, *(f"f {' '.join(str(i + 1) for i in face)}" for face in faces), ""]).encode()


def stl(vertices, faces):
    """Binary STL: every face with corners and a normal of its own."""
    body = b"".join(
        struct.pack("<12fH", 0, 0, 0, *np.asarray(vertices)[list(face)].ravel(), 0) for face in faces
    )
    return b"\0" * 80 + struct.pack("<I", len(faces)) + body


def ply(vertices, faces):
    head = f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
    head += (
        f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = [" ".join(map(repr, row)) for row in np.asarray(vertices, dtype=float).tolist()]
    rows += [" ".join(map(str, (len(face), *face))) for face in faces]
    return (head + "\n".join(rows) + "\n").encode()


def dae(vertices, faces, metre=1.0):
    """COLLADA: the unit is `metre` m, the upward axis y."""
    numbers = " ".join(repr(x) for x in np.asarray(vertices, dtype=float).ravel().tolist())
    indices = " ".join(str(i) for face in faces for i in face)
    count = len(vertices)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
<unit name="unit" meter="{metre}"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="{3 * count}">{numbers}
</float_array><technique_common><accessor source="#pa" count="{count}" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="{len(faces)}">
<input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


WRITERS = {"obj": obj, "stl": stl, "ply": ply, "dae": dae}
