"""The writers of files, which need no Blender."""

import struct
import zlib

import pytest

np = pytest.importorskip("numpy")

from blender_scene import elements, pictures, ply


def test_values_become_parameters_of_their_kind(tmp_path):
    texture = elements.plugin("texture", "bitmap", elements.string("filename", 'a "b" & c.png'))
    bsdf = elements.plugin(
        "bsdf",
        "principled",
        elements.parameter("base_color", texture),
        elements.parameter("roughness", 0.1),
        elements.parameter("specular", (0.0, 0.5, 1.0)),
        None,
        elements.transform("to_world", np.diag([2.0, 1.0, 1.0, 1.0])),
        id="x",
    )
    elements.write(elements.tree.ElementTree(bsdf).getroot(), tmp_path / "scene.xml")
    read = elements.tree.parse(tmp_path / "scene.xml").getroot()
    assert read.attrib == {"type": "principled", "id": "x"}
    assert [(child.tag, child.get("name")) for child in read] == [
        ("texture", "base_color"),
        ("float", "roughness"),
        ("rgb", "specular"),
        ("transform", "to_world"),
    ]
    assert read[0][0].get("value") == 'a "b" & c.png'
    assert read[1].get("value") == "0.1" and read[2].get("value") == "0, 0.5, 1"
    assert [float(number) for number in read[3][0].get("value").split()] == np.diag([2, 1, 1, 1]).ravel().tolist()


def test_what_shines_by_a_texture_is_lit_by_d65():
    lit = elements.radiance(elements.plugin("texture", "bitmap"))
    assert (lit.tag, lit.get("type"), lit.get("name"), lit[0].get("type")) == ("spectrum", "d65", "radiance", "bitmap")
    assert elements.radiance(2.0).tag == "float"


def read_ply(path):
    header, _, data = path.read_bytes().partition(b"end_header\n")
    lines = header.decode().splitlines()
    count, faces = (int(line.split()[2]) for line in lines if line.startswith("element"))
    names = [line.split()[2] for line in lines if line.startswith("property float")]
    vertices = np.frombuffer(data, "<f4", count * len(names)).reshape(count, len(names))
    rest = np.frombuffer(data[vertices.nbytes :], [("count", "u1"), ("corners", "<i4", 3)])
    assert len(rest) == faces and (rest["count"] == 3).all()
    return names, vertices, rest["corners"]


def test_equal_corners_are_one_vertex_and_sharp_edges_are_two(tmp_path):
    places = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=np.float32)
    flat = np.tile(np.array([0, 0, 1], dtype=np.float32), (6, 1))
    ply.write(tmp_path / "a.ply", places, flat, places[:, :2], {"painted": places})
    names, vertices, corners = read_ply(tmp_path / "a.ply")
    assert names == ["x", "y", "z", "nx", "ny", "nz", "u", "v", "painted_r", "painted_g", "painted_b"]
    assert len(vertices) == 4 and np.array_equal(vertices[corners.ravel()][:, :3], places)
    assert np.array_equal(vertices[corners.ravel()][:, 6:8], places[:, :2])
    tilted = flat.copy()
    tilted[3:] = (0, 1, 0)
    ply.write(tmp_path / "b.ply", places, tilted, None)
    names, vertices, corners = read_ply(tmp_path / "b.ply")
    assert len(vertices) == 6 and np.array_equal(vertices[corners.ravel()], np.hstack([places, tilted]))


def test_pictures_have_their_rows_where_they_belong():
    below, above = [(0.0, 0.2, 1.0)], [(1.0, 0.4, 2.0)]
    values = np.array([below, above])  # two rows of one pixel, the lower first
    assert pictures.pfm(values)[:14] == b"PF\n1 2\n-1.0\n" + struct.pack("<f", 0.0)[:2]
    assert np.array_equal(np.frombuffer(pictures.pfm(values)[-24:], "<f4"), values.astype("f4").ravel())
    assert pictures.pgm(values[:, :, 1]) == b"P5\n1 2\n65535\n" + struct.pack(">HH", 26214, 13107)
    png = pictures.png(values)
    start = png.index(b"IDAT")
    (length,) = struct.unpack(">I", png[start - 4 : start])
    assert zlib.decompress(png[start + 4 : start + 4 + length]) == bytes([0, 255, 102, 255, 0, 0, 51, 255])
    assert struct.unpack(">I", png[start + 4 + length :][:4])[0] == zlib.crc32(png[start : start + 4 + length])
