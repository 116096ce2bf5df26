"""Arrays of scenes that are read, set and rendered again."""

import etalon as et
import numpy as np
import pytest
from dict_scenes import PAIRS, assert_refused, pixels, scene, scene_xml, with_bsdf
from written_files import write_pfm, write_png, write_serialized, write_vol

SHEET = {
    "vertices": np.array([[-1, 0, -1], [1, 0, -1], [1, 0.25, 1], [-1, 0.25, 1]], np.float32),
    "faces": np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
    "uv": np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32),
    "vertex_color": np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]], np.float32),
}
COLOURED = {
    "type": "twosided",
    "inner": {"type": "diffuse", "reflectance": {"type": "mesh_attribute", "name": "vertex_color"}},
}
NORMALS = np.array([[0, -1, 0], [0.6, -0.8, 0], [0, -0.8, 0.6], [0, -1, 0]], np.float32)


def sheet(**arrays):
    return scene(ball={"type": "mesh", **SHEET, **arrays, "bsdf": COLOURED})


@pytest.mark.parametrize("name", PAIRS)
def test_the_same_arrays_are_the_same_scene(name):
    loaded = et.load_dict(scene(**PAIRS[name][0]))
    values = loaded.parameters(arrays=True)
    assert set(loaded.parameters()) <= set(values)
    assert np.array_equal(pixels(loaded.with_parameters(values)), pixels(loaded))


def test_arrays_are_those_that_were_given():
    loaded = et.load_dict(sheet(normals=NORMALS, face_height=[1.0, 2.0]))
    values = loaded.parameters(arrays=True)
    given = {**SHEET, "normals": NORMALS, "face_height": np.array([1, 2], np.float32)}
    assert {key for key in values if isinstance(values[key], np.ndarray) and key.startswith("ball.")} >= {
        f"ball.{key}" for key in given
    }
    for key, array in given.items():
        found = values[f"ball.{key}"]
        assert found.dtype == array.dtype and np.array_equal(found, array), key
    # They are copies.
    values["ball.vertices"][:] = 7
    assert np.array_equal(loaded.parameters(arrays=True)["ball.vertices"], SHEET["vertices"])
    assert not [key for key in loaded.parameters() if key.startswith("ball.vert")]


@pytest.mark.parametrize(
    "changes",
    [
        {"vertices": SHEET["vertices"] * 0.7},
        {"uv": SHEET["uv"] * 3, "vertices": SHEET["vertices"] * 0.7},
        {"normals": NORMALS},
        {"faces": np.array([[0, 1, 3]])},
        {"vertex_color": SHEET["vertex_color"][::-1]},
        {**{key: array[:3] for key, array in SHEET.items()}, "faces": [[2, 1, 0]]},
    ],
)
def test_a_changed_mesh_is_that_of_another_dict(changes):
    base = et.load_dict(sheet())
    before = pixels(base)
    wanted = pixels(et.load_dict(sheet(**changes)))
    changed = base.with_parameters({f"ball.{key}": array for key, array in changes.items()})
    assert np.array_equal(pixels(changed), wanted)
    assert not np.array_equal(wanted, before) and np.array_equal(pixels(base), before)
    # The names of Mitsuba, and one change after the other.
    names = {"vertices": "vertex_positions", "uv": "vertex_texcoords", "normals": "vertex_normals"}
    again = base.with_parameters({"ball.vertex_color": SHEET["vertex_color"]})
    again = again.with_parameters({f"ball.{names.get(key, key)}": array for key, array in changes.items()})
    assert np.array_equal(pixels(again), wanted)


def test_vertices_that_move_get_new_normals():
    base = et.load_dict(sheet(normals=NORMALS))
    moved = SHEET["vertices"] * [1, 3, 1]
    assert np.array_equal(
        pixels(base.with_parameters({"ball.vertices": moved})), pixels(et.load_dict(sheet(vertices=moved)))
    )
    kept = base.with_parameters({"ball.vertices": moved, "ball.normals": NORMALS})
    assert np.array_equal(pixels(kept), pixels(et.load_dict(sheet(vertices=moved, normals=NORMALS))))


# A tent with a seam of coordinates along its ridge, over which its normal is smooth.
OBJ = """v -1 0 -0.5
v 1 0 -0.5
v 0 -0.8 -0.5
v -1 0 1
v 1 0 1
v 0 -0.8 1
vt 0 0
vt 0.5 0
vt 0 1
vt 0.5 1
vt 0.6 0
vt 1 0
vt 0.6 1
vt 1 1
f 1/1 3/2 6/4
f 1/1 6/4 4/3
f 3/5 2/6 5/8
f 3/5 5/8 6/7
"""


def test_meshes_of_files_stay_what_they_are(tmp_path):
    def loaded(text):
        (tmp_path / "a.obj").write_text(text)
        bsdf = {"type": "twosided", "inner": {"type": "diffuse"}}
        return et.load_dict(scene(ball={"type": "obj", "filename": tmp_path / "a.obj", "bsdf": bsdf}))

    base = loaded(OBJ)
    values = base.parameters(arrays=True)
    assert values["ball.vertices"].shape == (8, 3) and values["ball.uv"].shape == (8, 2)
    assert np.array_equal(pixels(base.with_parameters({"ball.vertices": values["ball.vertices"]})), pixels(base))
    deep = base.with_parameters({"ball.vertices": values["ball.vertices"] * [1, 1.5, 1]})
    other = loaded(OBJ.replace("-0.8", "-1.2"))
    assert np.abs(pixels(deep) - pixels(other)).max() < 1e-5
    assert not np.array_equal(pixels(deep), pixels(base))


def test_a_mesh_of_many_in_a_file_is_that_of_its_index(tmp_path):
    vertices, faces = SHEET["vertices"], SHEET["faces"]
    write_serialized(tmp_path / "a.serialized", [(vertices[:3], faces[:1]), (vertices * 0.5, faces), (vertices, faces)])
    bsdf = {"type": "twosided", "inner": {"type": "diffuse"}}
    shape = {"type": "serialized", "filename": tmp_path / "a.serialized", "bsdf": bsdf}
    first = et.load_dict(scene(ball=shape)).parameters(arrays=True)
    assert first["ball.faces"].tolist() == [[0, 1, 2]]
    base = et.load_dict(scene(ball={**shape, "shape_index": 1}))
    assert np.array_equal(base.parameters(arrays=True)["ball.vertices"], vertices * 0.5)
    last = pixels(et.load_dict(scene(ball={**shape, "shape_index": 2})))
    assert np.array_equal(pixels(base.with_parameters({"ball.vertices": vertices})), last)
    assert not np.array_equal(pixels(base), last)


def test_pictures_can_be_others_of_any_size():
    rng = np.random.default_rng(3)
    first, second = rng.integers(0, 256, (4, 4, 3), np.uint8), rng.uniform(0, 1, (3, 7)).astype(np.float32)

    def picture(array):
        return et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": array}))

    base = picture(first)
    data = base.parameters(arrays=True)["ball.bsdf.reflectance.data"]
    assert data.dtype == np.uint8 and np.array_equal(data, first)
    changed = base.with_parameters({"ball.bsdf.reflectance.bitmap": second})
    assert np.array_equal(pixels(changed), pixels(picture(second)))
    found = changed.parameters(arrays=True)["ball.bsdf.reflectance.data"]
    assert found.dtype == np.float32 and np.array_equal(found, second)
    assert not np.array_equal(pixels(changed), pixels(base))


def test_files_are_asked_for_once(tmp_path):
    picture, sky, path = tmp_path / "a.png", tmp_path / "a.pfm", tmp_path / "scene.xml"
    rng = np.random.default_rng(4)
    write_png(picture, rng.integers(0, 256, (4, 4, 3), np.uint8))
    write_pfm(sky, rng.uniform(0, 1, (4, 8, 3)))
    path.write_text(
        scene_xml(
            ball="""<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
              <string name="filename" value="a.png"/></texture></bsdf></shape>""",
            light='<emitter type="envmap" id="sky"><string name="filename" value="a.pfm"/></emitter>',
        )
    )
    base = et.load_file(path)
    dark = np.full((2, 4, 3), 0.1, np.float32)
    wanted = pixels(base.with_parameters({"sky.data": dark, "sphere.radius": 0.5}))
    small = pixels(base.with_parameters({"sphere.radius": 0.5}))
    values = base.parameters(arrays=True)
    for file in (picture, sky, path):
        file.unlink()
    first = base.with_parameters({"sky.data": dark})
    assert np.array_equal(pixels(first.with_parameters({"sphere.radius": 0.5})), wanted)
    # The scene's own sky is still there, though it was another's at the first change.
    assert np.array_equal(pixels(base.with_parameters({"sphere.radius": 0.5})), small)
    assert np.array_equal(base.parameters(arrays=True)["sky.data"], values["sky.data"])
    assert np.array_equal(first.parameters(arrays=True)["sky.data"], dark)
    hashes = [et.render(one, spp=1).metadata["scene_hash"] for one in (first, base.with_parameters({"sky.data": dark}))]
    other = base.with_parameters({"sky.data": dark * 2})
    assert hashes[0] == hashes[1] != et.render(other, spp=1).metadata["scene_hash"]


def test_volumes_stay_in_their_boxes(tmp_path):
    array = np.random.default_rng(5).uniform(0, 1, (2, 3, 4))
    write_vol(tmp_path / "a.vol", array[..., None])
    raw = bytearray((tmp_path / "a.vol").read_bytes())
    raw[24:48] = np.array([-1, -1, -1, 1, 0.5, 1], "<f4").tobytes()
    (tmp_path / "a.vol").write_bytes(raw)
    grid = {"type": "gridvolume", "filename": tmp_path / "a.vol", "use_grid_bbox": True}
    medium = {"type": "heterogeneous", "sigma_t": grid, "albedo": 0.9, "scale": 3.0}
    shape = {"type": "cube", "bsdf": {"type": "null"}, "interior": medium}
    base = et.load_dict(scene(integrator={"type": "volpath"}, ball=shape))
    key = "ball.interior.sigma_t.data"
    found = base.parameters(arrays=True)[key]
    assert np.array_equal(found, array.astype(np.float32))
    changed = base.with_parameters({key: found[::-1]})
    raw[48:] = found[::-1].tobytes()
    (tmp_path / "a.vol").write_bytes(raw)
    wanted = pixels(et.load_dict(scene(integrator={"type": "volpath"}, ball=shape)))
    assert np.array_equal(pixels(changed), wanted) and not np.array_equal(pixels(base), wanted)


def test_inline_meshes_of_other_languages_are_arrays(tmp_path):
    path = tmp_path / "a.pbrt"
    text = """LookAt 0 -4 1  0 0 0  0 0 1
        Camera "perspective" "float fov" 40
        Film "rgb" "integer xresolution" 8 "integer yresolution" 6
        WorldBegin
        LightSource "infinite" "rgb L" [0.5 0.6 0.9]
        Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  0 0.3 TOP] "integer indices" [0 1 2]
        """
    path.write_text(text.replace("TOP", "1"))
    base = et.load_file(path)
    (key,) = [key for key in base.parameters(arrays=True) if key.endswith(".vertices")]
    vertices = base.parameters(arrays=True)[key]
    assert np.array_equal(vertices, np.array([[-1, 0, -1], [1, 0, -1], [0, 0.3, 1]], np.float32))
    vertices[2, 2] = 0.5
    changed = base.with_parameters({key: vertices})
    path.write_text(text.replace("TOP", "0.5"))
    assert np.array_equal(pixels(changed), pixels(et.load_file(path)))
    assert not np.array_equal(pixels(changed), pixels(base))


@pytest.mark.parametrize(
    "changes, key, words",
    [
        ({"ball.vertices": np.zeros((3, 3))}, "ball.vertices", "it has 3 rows for 4 vertices of the old faces"),
        ({"ball.vertices": np.zeros((4, 2))}, "ball.vertices", "it is an array of N × 3, not 4 × 2"),
        ({"ball.vertices": np.full((4, 3), np.inf)}, "ball.vertices", "which is not finite"),
        ({"ball.faces": [[0, 1, 4]]}, "ball.faces", "face 0 has the vertex 4, but there are 4"),
        ({"ball.uv": [[0, 1]]}, "ball.uv", "it has 1 rows for 4 vertices"),
        ({"ball.vertex_color": "red"}, "ball.vertex_color", "not a single value"),
        (
            {"ball.uv": SHEET["uv"], "ball.vertex_texcoords": SHEET["uv"]},
            "ball.vertex_texcoords",
            "it is given twice, as `uv`, too",
        ),
        ({"sky.data": np.zeros((2, 4, 2))}, "sky.data", "a picture is an array of height × width"),
        ({"sky.data": 3}, "sky.data", "an int is no array"),
        ({"sky.data": np.ones((2, 4)), "sky.bitmap": np.ones((2, 4))}, "sky.bitmap", "it is given twice"),
        ({"sky.grid": np.ones((2, 4))}, "sky.grid", "an array of 2 × 4 can be no value of a scene"),
        ({"floor.vertices": np.zeros((4, 3))}, "floor.vertices", "an array of 4 × 3 can be no value of a scene"),
    ],
)
def test_mistakes_have_paths(changes, key, words):
    sky = {"type": "envmap", "data": np.ones((2, 4, 3), np.float32)}
    base = et.load_dict(scene(ball=sheet()["ball"], light=None, sky=sky))
    assert_refused(lambda: base.with_parameters(changes), key, words)
    assert pixels(base).mean() > 0


def test_files_that_are_gone_are_told(tmp_path):
    write_png(tmp_path / "a.png", np.full((2, 2, 3), 99, np.uint8))
    texture = {"type": "bitmap", "filename": tmp_path / "a.png"}
    base = et.load_dict(with_bsdf(type="diffuse", reflectance=texture))
    (tmp_path / "a.png").unlink()
    with pytest.raises(ValueError, match="was not found"):
        base.parameters(arrays=True)
    assert "ball.radius" in base.parameters()
