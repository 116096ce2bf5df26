"""Arrays in dicts are what files with the same contents are."""

import etalon as et
import numpy as np
import pytest
from dict_scenes import CHECKER, T, ball, pixels, scene, with_bsdf
from written_files import write_pfm, write_png, write_vol


def test_dollars_and_markup_are_text(tmp_path):
    folder = tmp_path / "a $b & <c>"
    folder.mkdir()
    pixel = np.full((1, 1, 3), 128, np.uint8)
    write_png(folder / 'd"e.png', pixel)
    reflectance = {"type": "bitmap", "filename": folder / 'd"e.png'}
    from_file = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance=reflectance)))
    from_array = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": pixel})))
    assert np.array_equal(from_file, from_array)
    found = scene(
        files={"type": "resources", "path": folder},
        ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "bitmap", "filename": 'd"e.png'}}),
    )
    assert np.array_equal(pixels(et.load_dict(found)), from_array)


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("kind", ["uint8", "float32", "float64"])
@pytest.mark.parametrize("raw", [False, True])
def test_pictures_in_arrays_are_those_of_files(channels, kind, raw, tmp_path):
    rng = np.random.default_rng(channels)
    array = (
        rng.integers(0, 256, (3, 5, channels), np.uint8)
        if kind == "uint8"
        else rng.uniform(0, 1, (3, 5, channels)).astype(kind)
    )
    path = tmp_path / ("a.png" if kind == "uint8" else "a.pfm")
    (write_png if kind == "uint8" else write_pfm)(path, array)
    texture = {"type": "bitmap", "raw": raw, "filter_type": "nearest"}

    def picture(**source):
        # A number that is one, so that raw colours are understood.
        bsdf = {"type": "mask", "opacity": {**texture, **source}, "inner": {"type": "diffuse"}}
        return pixels(et.load_dict(scene(ball=ball(bsdf=bsdf))))

    of_file = picture(filename=path)
    assert np.array_equal(picture(data=array), of_file)
    # Neither the order of memory nor the name of the key matters.
    assert np.array_equal(picture(bitmap=np.asfortranarray(array)), of_file)
    assert not np.array_equal(picture(data=array[::-1]), of_file)
    assert not np.array_equal(picture(data=array[:, ::-1]), of_file)
    if channels == 1:
        assert np.array_equal(picture(data=array[:, :, 0]), of_file)


def test_surroundings_in_arrays_are_those_of_files(tmp_path):
    array = np.random.default_rng(2).uniform(0, 3, (4, 8, 3)).astype(np.float32)
    write_pfm(tmp_path / "sky.pfm", array)
    of_file = pixels(et.load_dict(scene(light={"type": "envmap", "filename": str(tmp_path / "sky.pfm")})))
    assert np.array_equal(pixels(et.load_dict(scene(light={"type": "envmap", "data": array}))), of_file)
    opaque = np.concatenate([array, np.ones((4, 8, 1), np.float32)], axis=2)
    assert np.array_equal(pixels(et.load_dict(scene(light={"type": "envmap", "bitmap": opaque}))), of_file)


@pytest.mark.parametrize("channels", [1, 3])
def test_volumes_in_arrays_are_those_of_files(channels, tmp_path):
    array = np.random.default_rng(channels).uniform(0, 1, (2, 3, 4, channels))
    write_vol(tmp_path / "a.vol", array)
    place = T().translate([-1, -1, -1]).scale(2)

    def picture(**source):
        grid = {"type": "gridvolume", "to_world": place, **source}
        medium = {"type": "heterogeneous", "sigma_t": 2.0, "albedo": 0.9}
        medium["sigma_t" if channels == 1 else "albedo"] = grid
        shape = {"type": "cube", "bsdf": {"type": "null"}, "interior": medium}
        return pixels(et.load_dict(scene(integrator={"type": "volpath"}, ball=shape)))

    of_file = picture(filename=tmp_path / "a.vol")
    assert np.array_equal(picture(data=array), of_file)
    assert np.array_equal(picture(grid=array.astype(np.float32)), of_file)
    assert not np.array_equal(picture(data=array[::-1]), of_file)
    if channels == 1:
        assert np.array_equal(picture(data=array[..., 0]), of_file)


def test_distances_in_arrays_are_those_of_files(tmp_path):
    z, y, x = np.meshgrid(*[np.linspace(0, 1, n) for n in (9, 8, 7)], indexing="ij")
    array = np.sqrt((x - 0.5) ** 2 + (y - 0.5) ** 2 + 2 * (z - 0.5) ** 2) - 0.35
    write_vol(tmp_path / "a.vol", array[..., None])
    place = {"type": "sdfgrid", "to_world": T().translate([-1, -1, -1]).scale(2)}
    of_file = pixels(et.load_dict(scene(ball={**place, "filename": tmp_path / "a.vol"})))
    assert np.array_equal(pixels(et.load_dict(scene(ball={**place, "grid": array}))), of_file)
    assert not np.array_equal(pixels(et.load_dict(scene())), of_file)


PLY = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property float nx
property float ny
property float nz
property float u
property float v
property float r
property float g
property float b
element face 2
property list uchar int vertex_indices
end_header
-1 0 -1 0 -1 0 0 0 1 0 0
1 0 -1 0.6 -0.8 0 1 0 0 1 0
1 0.25 1 0 -0.8 0.6 1 1 0 0 1
-1 0.25 1 0 -1 0 0 1 1 1 0
3 0 1 2
3 0 2 3
"""


def test_meshes_in_arrays_are_those_of_files(tmp_path):
    (tmp_path / "a.ply").write_text(PLY)
    columns = np.array([line.split() for line in PLY.split("end_header\n")[1].splitlines()[:4]], dtype=float)
    arrays = {
        "vertices": columns[:, :3],
        "normals": columns[:, 3:6],
        "uv": columns[:, 6:8].astype(np.float32),
        "faces": np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32),
        "vertex_color": columns[:, 8:11],
    }
    bsdfs = [
        {"type": "diffuse", "reflectance": CHECKER},
        {"type": "diffuse", "reflectance": {"type": "mesh_attribute", "name": "vertex_color"}},
    ]
    seen = []
    for bsdf in bsdfs:
        more = {"bsdf": {"type": "twosided", "inner": bsdf}, "to_world": T().scale(1.2)}
        of_file = pixels(et.load_dict(scene(ball={"type": "ply", "filename": tmp_path / "a.ply", **more})))
        assert np.array_equal(pixels(et.load_dict(scene(ball={"type": "mesh", **arrays, **more}))), of_file)
        # As Mitsuba's own meshes name and flatten them.
        flat = {
            "vertex_positions": arrays["vertices"].ravel(),
            "vertex_normals": arrays["normals"].ravel(),
            "vertex_texcoords": arrays["uv"].ravel(),
            "faces": arrays["faces"].ravel(),
            "vertex_color": arrays["vertex_color"],
        }
        assert np.array_equal(pixels(et.load_dict(scene(ball={"type": "mesh", **flat, **more}))), of_file)
        without = {key: array for key, array in arrays.items() if key != "normals"}
        assert not np.array_equal(pixels(et.load_dict(scene(ball={"type": "mesh", **without, **more}))), of_file)
        seen.append(of_file)
    assert not np.array_equal(*seen)


def test_arrays_are_copied_and_no_part_of_texts():
    array = np.full((2, 2, 3), 0.5)
    loaded = et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": array}))
    before = pixels(loaded)
    first = et.render(loaded, spp=1).metadata["scene_hash"]
    array[:] = 0.1
    assert np.array_equal(et.render(loaded, spp=4, seed=1, integrator="path").numpy(), before)
    changed = with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": array})
    assert et.render(et.load_dict(changed), spp=1).metadata["scene_hash"] != first
    with pytest.raises(
        et.SceneError, match=r"^ball\.bsdf\.reflectance\.data: error: an array does not stand in a text"
    ):
        et.dict_to_xml(changed)
    # A dict is left as it was.
    assert changed["ball"]["bsdf"]["reflectance"]["data"] is array
