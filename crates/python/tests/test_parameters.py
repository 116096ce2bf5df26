"""Values of scenes that are read, set and rendered again."""

import etalon as et
import numpy as np
import pytest
from dict_scenes import (
    CHECKER,
    LOOK,
    PAIRS,
    PARTS_XML,
    T,
    assert_refused,
    ball,
    pixels,
    scene,
    scene_xml,
    with_bsdf,
)
from written_files import write_png


def test_values_are_those_of_the_dict():
    values = et.load_dict(scene(ball=ball(bsdf={"type": "diffuse", "reflectance": CHECKER}))).parameters()
    assert values["ball.radius"] == 0.9 and values["sensor.film.width"] == 8
    assert values["ball.bsdf.reflectance.color1"] == pytest.approx([0.9, 0.2, 0.1])
    assert values["sensor.to_world"] == pytest.approx(LOOK.matrix)
    assert values["lamp.intensity"] == 20.0 and values["lamp.position"].tolist() == [1, -2, 3]
    spectrum = {"type": "spectrum", "value": [(400, 0.1), (700, 0.2)]}
    lit = et.load_dict(with_bsdf(type="diffuse", reflectance=spectrum)).parameters()
    assert lit["ball.bsdf.reflectance"].tolist() == [[400, 0.1], [700, 0.2]]


@pytest.mark.parametrize("name", PAIRS)
def test_the_same_values_are_the_same_scene(name):
    loaded = et.load_dict(scene(**PAIRS[name][0]))
    again = loaded.with_parameters(loaded.parameters())
    assert np.array_equal(pixels(again), pixels(loaded))
    assert list(again.parameters()) == list(loaded.parameters())


@pytest.mark.parametrize(
    "path, value, parts",
    [
        ("ball.radius", 0.5, dict(ball=ball(radius=0.5))),
        ("ball.center", [0.3, 0, 0], dict(ball=ball(center=[0.3, 0, 0]))),
        (
            "lamp.position",
            (0, -3, 2),
            dict(lamp={"type": "point", "position": [0, -3, 2], "intensity": {"type": "spectrum", "value": 20}}),
        ),
        (
            "light.radiance",
            [0.9, 0.1, 0.1],
            dict(light={"type": "constant", "radiance": {"type": "rgb", "value": [0.9, 0.1, 0.1]}}),
        ),
        ("light.radiance", 0.25, dict(light={"type": "constant", "radiance": {"type": "rgb", "value": 0.25}})),
        ("floor.to_world", T().scale(2), dict(floor={"type": "rectangle", "to_world": T().scale(2)})),
        (
            "lamp.intensity",
            [(400, 5), (700, 30)],
            dict(
                lamp={
                    "type": "point",
                    "position": [1, -2, 3],
                    "intensity": {"type": "spectrum", "value": [(400, 5), (700, 30)]},
                }
            ),
        ),
        ("integrator.max_depth", 2, dict(integrator={"type": "path", "max_depth": 2})),
    ],
)
def test_a_changed_value_is_that_of_another_dict(path, value, parts):
    base = et.load_dict(scene())
    before = pixels(base)
    changed = base.with_parameters({path: value})
    assert np.array_equal(pixels(changed), pixels(et.load_dict(scene(**parts))))
    assert not np.array_equal(pixels(changed), before) and np.array_equal(pixels(base), before)
    # What was changed stays so in other sizes, and with another integrator.
    other = dict(spp=2, seed=3, size=(6, 5))
    assert np.array_equal(et.render(changed, **other).numpy(), et.render(et.load_dict(scene(**parts)), **other).numpy())
    direct = et.render(changed, spp=2, seed=3, integrator="direct").numpy()
    assert np.array_equal(direct, et.render(et.load_dict(scene(**parts)), spp=2, seed=3, integrator="direct").numpy())


def test_changes_add_up_and_shared_objects_stay_shared():
    clay = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.7, 0.3, 0.2]}}
    ref = {"type": "ref", "id": "clay"}
    base = et.load_dict(
        scene(clay=clay, ball=ball(bsdf=ref), other={"type": "cube", "to_world": T().scale(0.3), "bsdf": ref})
    )
    assert [key for key in base.parameters() if "reflectance" in key] == ["clay.reflectance"]
    step = base.with_parameters({"clay.reflectance": [0.1, 0.1, 0.8]}).with_parameters({"ball.radius": 0.4})
    final = step.with_parameters({"ball.radius": 0.6})
    clay = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.1, 0.1, 0.8]}}
    same = et.load_dict(
        scene(
            clay=clay, ball=ball(radius=0.6, bsdf=ref), other={"type": "cube", "to_world": T().scale(0.3), "bsdf": ref}
        )
    )
    assert np.array_equal(pixels(final), pixels(same))
    hashes = [et.render(one, spp=1).metadata["scene_hash"] for one in (base, step, final)]
    assert len(set(hashes)) == 3
    again = base.with_parameters({"clay.reflectance": [0.1, 0.1, 0.8], "ball.radius": 0.6})
    assert et.render(again, spp=1).metadata["scene_hash"] == hashes[2]


def test_a_texture_becomes_a_colour():
    base = et.load_dict(with_bsdf(type="diffuse", reflectance=CHECKER))
    red = with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": [0.9, 0.1, 0.1]})
    for value in ([0.9, 0.1, 0.1], {"type": "rgb", "value": [0.9, 0.1, 0.1]}):
        assert np.array_equal(pixels(base.with_parameters({"ball.bsdf.reflectance": value})), pixels(et.load_dict(red)))


def test_files_are_read_once(tmp_path):
    path, picture = tmp_path / "scene.xml", tmp_path / "a.png"
    write_png(picture, np.random.default_rng(1).integers(0, 256, (4, 4, 3), np.uint8))
    mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    mesh += "element face 1\nproperty list uchar int vertex_indices\nend_header\n-2 1 -1\n2 1 -1\n0 1 2\n3 0 1 2\n"
    (tmp_path / "a.ply").write_text(mesh)
    path.write_text(
        scene_xml(
            ball="""<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
              <string name="filename" value="a.png"/></texture></bsdf><float name="radius" value="0.9"/></shape>""",
            wall='<shape type="ply" id="wall"><string name="filename" value="a.ply"/></shape>',
        )
    )
    base = et.load_file(path)
    values = base.parameters()
    assert values["sphere.radius"] == 0.9 and "rectangle.to_world" in values
    assert not [key for key in values if "filename" in key]
    wanted = pixels(base.with_parameters({"sphere.radius": 0.5}))
    for file in (path, picture, tmp_path / "a.ply"):
        file.unlink()
    assert np.array_equal(pixels(base.with_parameters({"sphere.radius": 0.5})), wanted)
    smaller = base.with_parameters({"sphere.radius": 0.7}).with_parameters({"sphere.radius": 0.5})
    assert np.array_equal(pixels(smaller), wanted)
    assert np.array_equal(et.render(smaller, spp=4, seed=1, crop=(2, 1, 4, 3)).numpy(), wanted[1:4, 2:6])


def test_every_language_has_values(tmp_path):
    xml = et.load_string(scene_xml(second=PARTS_XML["ball"]))
    assert {"sphere.radius", "sphere_2.radius", "point.position", "perspective.hdrfilm.width"} <= set(xml.parameters())
    moved = xml.with_parameters({"sphere_2.center": [1, 0, 0], "sphere_2.radius": 0.3})
    more = '<shape type="sphere"><float name="radius" value="0.3"/><point name="center" value="1, 0, 0"/></shape>'
    assert np.array_equal(pixels(moved), pixels(et.load_string(scene_xml(second=more))))
    pbrt = tmp_path / "a.pbrt"
    pbrt.write_text("""LookAt 0 -4 1  0 0 0  0 0 1
        Camera "perspective" "float fov" 40
        Film "rgb" "integer xresolution" 8 "integer yresolution" 6
        WorldBegin
        LightSource "infinite" "rgb L" [0.5 0.6 0.9]
        Material "diffuse" "rgb reflectance" [0.1 0.7 0.2]
        Shape "sphere" "float radius" RADIUS
        """.replace("RADIUS", "0.9"))
    base = et.load_file(pbrt)
    (radius,) = [key for key in base.parameters() if key.endswith(".radius") and base.parameters()[key] == 0.9]
    small = base.with_parameters({radius: 0.5})
    pbrt.write_text(pbrt.read_text().replace("0.9\n", "0.5\n"))
    assert np.array_equal(pixels(small), pixels(et.load_file(pbrt)))


@pytest.mark.parametrize(
    "changes, key, words",
    [
        ({"bal.radius": 1}, "bal.radius", "no object `bal` (did you mean `ball`?)"),
        ({"ball.radus": 1}, "ball", "`sphere` has no parameter `radus` (did you mean `radius`?)"),
        ({"ball.radius": -1}, "ball.radius", "cannot be -1"),
        ({"ball.radius": float("nan")}, "ball.radius", "`NaN` is not a finite number"),
        ({"ball.radius": None}, "ball.radius", "None can be no value of a scene"),
        ({"ball": 3}, "ball", "this is no value"),
        ({"ball.bsdf": 3}, "ball.bsdf", "this is an object (bsdf) and no value"),
        ({"ball.bsdf.reflectance": {"type": "checkerboard"}}, "ball.bsdf.reflectance", "objects cannot be replaced"),
        ({"ball.bsdf.reflectance": [(500, 1), (400, 1)]}, "ball.bsdf.reflectance", "wavelengths must ascend"),
        ({"ball.bsdf.filename": "a.png"}, "ball.bsdf.filename", "load the scene again"),
    ],
)
def test_mistakes_have_paths(changes, key, words):
    base = et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": 0.5}))
    assert_refused(lambda: base.with_parameters(changes), key, words)
    assert pixels(base).mean() > 0


def test_changes_that_lost_their_place_are_told(tmp_path):
    path = tmp_path / "scene.xml"
    path.write_text(scene_xml())
    changed = et.load_file(path).with_parameters({"sphere.radius": 0.5})
    path.write_text(scene_xml(ball=""))
    # Another integrator means that the file is read again.
    with pytest.raises(et.SceneError, match="the scene has nothing at `sphere.radius` with these options"):
        et.render(changed, integrator="direct")
    with pytest.raises(TypeError):
        changed.with_parameters({3: 4})
