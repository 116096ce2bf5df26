"""Scenes as dicts: each gives the picture of its XML, and arrays that of files with the same contents."""

import copy
import re
from pathlib import Path

import etalon as et
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
T = et.Transform

LOOK = T().look_at(origin=[0, -4, 1.5], target=[0, 0, 0], up=[0, 0, 1])
LOOK_XML = '<transform name="to_world"><lookat origin="0, -4, 1.5" target="0, 0, 0" up="0, 0, 1"/></transform>'
FILM = {"type": "hdrfilm", "width": 8, "height": 6, "filter": {"type": "box"}}
FILM_XML = """<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/>
  <rfilter type="box"/></film>"""

# What a scene has unless it has its own.
PARTS = {
    "integrator": {"type": "path", "max_depth": 4},
    "sensor": {"type": "perspective", "fov": 40, "to_world": LOOK, "film": FILM},
    "light": {"type": "constant", "radiance": {"type": "rgb", "value": [0.5, 0.6, 0.9]}},
    "lamp": {"type": "point", "position": [1, -2, 3], "intensity": {"type": "spectrum", "value": 20}},
    "ball": {"type": "sphere", "radius": 0.9},
    "floor": {"type": "rectangle", "to_world": T().translate([0, 0, -1]).scale(3)},
}
PARTS_XML = {
    "integrator": '<integrator type="path"><integer name="max_depth" value="4"/></integrator>',
    "sensor": f'<sensor type="perspective"><float name="fov" value="40"/>{LOOK_XML}{FILM_XML}</sensor>',
    "light": '<emitter type="constant"><rgb name="radiance" value="0.5, 0.6, 0.9"/></emitter>',
    "lamp": """<emitter type="point"><point name="position" value="1, -2, 3"/>
      <spectrum name="intensity" value="20"/></emitter>""",
    "ball": '<shape type="sphere"><float name="radius" value="0.9"/></shape>',
    "floor": """<shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-1"/></transform>
      </shape>""",
}


def scene(**parts):
    """A dict with these parts in place of the usual ones; None takes one away."""
    parts = {**PARTS, **parts}
    return {"type": "scene", **{key: part for key, part in parts.items() if part is not None}}


def scene_xml(**parts):
    return '<scene version="3.0.0">' + "\n".join({**PARTS_XML, **parts}.values()) + "</scene>"


def ball(**more):
    return {"type": "sphere", "radius": 0.9, **more}


def ball_xml(more):
    return PARTS_XML["ball"].replace("</shape>", more + "</shape>")


def pixels(loaded):
    return et.render(loaded, spp=4, seed=1).numpy()


def sensor_xml(kind, more=""):
    return f'<sensor type="{kind}">{more}{LOOK_XML}{FILM_XML}</sensor>'


CHECKER = {
    "type": "checkerboard",
    "color0": {"type": "rgb", "value": 0.1},
    "color1": {"type": "rgb", "value": [0.9, 0.2, 0.1]},
    "to_uv": np.array([[4, 0, 0.5], [0, 2, 0], [0, 0, 1.0]]),
}
CHECKER_XML = """<texture type="checkerboard" name="NAME"><rgb name="color0" value="0.1"/>
  <rgb name="color1" value="0.9, 0.2, 0.1"/>
  <transform name="to_uv"><scale x="4" y="2"/><translate x="0.5"/></transform></texture>"""
FOG = {"type": "homogeneous", "sigma_t": 1.5, "albedo": {"type": "rgb", "value": [0.9, 0.8, 0.7]}}
FOG_XML = '<float name="sigma_t" value="1.5"/><rgb name="albedo" value="0.9, 0.8, 0.7"/>'

# Parts as a dict and as XML.
PAIRS = {
    "as it is": ({}, {}),
    "tuple for a point": (
        dict(ball=ball(center=(0.3, 0, np.float32(0.25)))),
        dict(ball=ball_xml('<point name="center" x="0.3" y="0" z="0.25"/>')),
    ),
    "cube": (
        dict(ball={"type": "cube", "to_world": T().rotate([0, 0, 1], 30)}),
        dict(ball="""<shape type="cube"><transform name="to_world"><rotate z="1" angle="30"/></transform></shape>"""),
    ),
    "cylinder": (
        dict(ball={"type": "cylinder", "p0": [0, 0, -1], "p1": np.array([0, 0.5, 1]), "radius": 0.5, "flip_normals": True}),
        dict(
            ball="""<shape type="cylinder"><point name="p0" value="0, 0, -1"/><point name="p1" value="0, 0.5, 1"/>
              <float name="radius" value="0.5"/><boolean name="flip_normals" value="true"/></shape>"""
        ),
    ),
    "matrix in lists": (
        dict(ball={"type": "disk", "to_world": [[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0.5], [0, 0, 0, 1]]}),
        dict(
            ball="""<shape type="disk"><transform name="to_world"><matrix value="1 0 0 0 0 0 -1 0 0 1 0 0.5 0 0 0 1"/>
              </transform></shape>"""
        ),
    ),
    "instances": (
        dict(
            group={"type": "shapegroup", "one": {"type": "sphere", "radius": 0.3}, "two": {"type": "cube", "to_world": T().scale(0.2)}},
            ball={"type": "instance", "of": {"type": "ref", "id": "group"}, "to_world": T().translate([0.8, 0, 0])},
        ),
        dict(
            group="""<shape type="shapegroup" id="group"><shape type="sphere"><float name="radius" value="0.3"/></shape>
              <shape type="cube"><transform name="to_world"><scale value="0.2"/></transform></shape></shape>""",
            ball="""<shape type="instance"><ref id="group"/><transform name="to_world"><translate x="0.8"/></transform>
              </shape>""",
        ),
    ),
    "diffuse spectrum": (
        dict(ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "spectrum", "value": [(400, 0.1), (550, 0.9), (700, 0.2)]}})),
        dict(ball=ball_xml('<bsdf type="diffuse"><spectrum name="reflectance" value="400:0.1, 550:0.9, 700:0.2"/></bsdf>')),
    ),
    "dielectric": (
        dict(ball=ball(bsdf={"type": "dielectric", "int_ior": "diamond", "ext_ior": 1.0})),
        dict(
            ball=ball_xml(
                """<bsdf type="dielectric"><string name="int_ior" value="diamond"/><float name="ext_ior" value="1"/>
                  </bsdf>"""
            )
        ),
    ),
    "rough conductor": (
        dict(ball=ball(bsdf={"type": "roughconductor", "material": "Au", "alpha": np.float64(0.2), "distribution": "ggx"})),
        dict(
            ball=ball_xml(
                """<bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.2"/>
                  <string name="distribution" value="ggx"/></bsdf>"""
            )
        ),
    ),
    "plastic": (
        dict(ball=ball(bsdf={"type": "plastic", "diffuse_reflectance": {"type": "rgb", "value": np.array([0.1, 0.3, 0.4])}, "nonlinear": True})),
        dict(
            ball=ball_xml(
                """<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1, 0.3, 0.4"/>
                  <boolean name="nonlinear" value="true"/></bsdf>"""
            )
        ),
    ),
    "principled": (
        dict(ball=ball(material={"type": "principled", "base_color": {"type": "rgb", "value": [1, 0.5, 0]}, "metallic": 0.7, "roughness": 0.4})),
        dict(
            ball=ball_xml(
                """<bsdf type="principled"><rgb name="base_color" value="1, 0.5, 0"/><float name="metallic" value="0.7"/>
                  <float name="roughness" value="0.4"/></bsdf>"""
            )
        ),
    ),
    "blend of two sides": (
        dict(
            ball=ball(
                bsdf={
                    "type": "twosided",
                    "both": {"type": "blendbsdf", "weight": 0.3, "first": {"type": "diffuse"}, "second": {"type": "conductor"}},
                }
            )
        ),
        dict(
            ball=ball_xml(
                """<bsdf type="twosided"><bsdf type="blendbsdf"><float name="weight" value="0.3"/>
                  <bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></bsdf>"""
            )
        ),
    ),
    "mask by a texture": (
        dict(ball=ball(bsdf={"type": "mask", "opacity": CHECKER, "inner": {"type": "diffuse"}})),
        dict(ball=ball_xml(f'<bsdf type="mask">{CHECKER_XML.replace("NAME", "opacity")}<bsdf type="diffuse"/></bsdf>')),
    ),
    "checkerboard": (
        dict(ball=ball(bsdf={"type": "diffuse", "reflectance": CHECKER})),
        dict(ball=ball_xml(f'<bsdf type="diffuse">{CHECKER_XML.replace("NAME", "reflectance")}</bsdf>')),
    ),
    "texture by a formula": (
        dict(ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "expression", "k": 9, "value": "0.5 + 0.4*sin(k*x)"}})),
        dict(
            ball=ball_xml(
                """<bsdf type="diffuse"><texture type="expression" name="reflectance"><integer name="k" value="9"/>
                  <string name="value" value="0.5 + 0.4*sin(k*x)"/></texture></bsdf>"""
            )
        ),
    ),
    "reference by key": (
        dict(
            clay={"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.7, 0.3, 0.2]}},
            ball=ball(bsdf={"type": "ref", "id": "clay"}),
        ),
        dict(
            clay='<bsdf type="diffuse" id="clay"><rgb name="reflectance" value="0.7, 0.3, 0.2"/></bsdf>',
            ball=ball_xml('<ref id="clay"/>'),
        ),
    ),
    "references by id and by path": (
        dict(
            ball=ball(bsdf={"type": "plastic", "id": "wax"}),
            small={"type": "sphere", "radius": 0.2, "center": [1, -1, 0], "bsdf": {"type": "ref", "id": "wax"}},
            floor={**PARTS["floor"], "bsdf": {"type": "ref", "id": "ball.bsdf"}},
        ),
        dict(
            ball=ball_xml('<bsdf type="plastic" id="wax"/>'),
            small="""<shape type="sphere"><float name="radius" value="0.2"/><point name="center" value="1, -1, 0"/>
              <ref id="wax"/></shape>""",
            floor=PARTS_XML["floor"].replace("</shape>", '<ref id="wax"/></shape>'),
        ),
    ),
    "reference to a colour": (
        dict(
            red={"type": "rgb", "value": [0.9, 0.1, 0.1]},
            ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "ref", "id": "red"}}),
        ),
        dict(ball=ball_xml('<bsdf type="diffuse"><rgb name="reflectance" value="0.9, 0.1, 0.1"/></bsdf>')),
    ),
    "area light": (
        dict(ball=ball(emitter={"type": "area", "radiance": {"type": "blackbody", "temperature": 3000}})),
        dict(
            ball=ball_xml(
                """<emitter type="area"><spectrum type="blackbody" name="radiance"><float name="temperature" value="3000"/>
                  </spectrum></emitter>"""
            )
        ),
    ),
    "spot": (
        dict(lamp={"type": "spot", "to_world": T().look_at([1, -2, 3], [0, 0, 0]), "cutoff_angle": 15, "intensity": {"type": "d65", "scale": 40}}),
        dict(
            lamp="""<emitter type="spot"><transform name="to_world"><lookat origin="1, -2, 3" target="0, 0, 0"/></transform>
              <float name="cutoff_angle" value="15"/>
              <spectrum type="d65" name="intensity"><float name="scale" value="40"/></spectrum></emitter>"""
        ),
    ),
    "directional": (
        dict(lamp={"type": "directional", "direction": [1, 1, -1], "irradiance": {"type": "rgb", "value": 2}}),
        dict(lamp="""<emitter type="directional"><vector name="direction" value="1, 1, -1"/><rgb name="irradiance" value="2"/></emitter>"""),
    ),
    "sky": (
        dict(light={"type": "sunsky", "turbidity": 4.5, "sun_scale": 0, "to_world": T().rotate([1, 0, 0], 90)}),
        dict(
            light="""<emitter type="sunsky"><float name="turbidity" value="4.5"/><float name="sun_scale" value="0"/>
              <transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>"""
        ),
    ),
    "fog inside": (
        dict(
            integrator={"type": "volpath", "max_depth": 6},
            ball=ball(bsdf={"type": "null"}, interior={**FOG, "phase": {"type": "hg", "g": 0.6}}),
        ),
        dict(
            integrator='<integrator type="volpath"><integer name="max_depth" value="6"/></integrator>',
            ball=ball_xml(
                f"""<bsdf type="null"/><medium type="homogeneous" name="interior">{FOG_XML}
                  <phase type="hg"><float name="g" value="0.6"/></phase></medium>"""
            ),
        ),
    ),
    "medium by reference": (
        dict(integrator={"type": "volpath"}, fog=FOG, ball=ball(bsdf={"type": "dielectric"}, interior={"type": "ref", "id": "fog"})),
        dict(
            integrator='<integrator type="volpath"/>',
            fog=f'<medium type="homogeneous" id="fog">{FOG_XML}</medium>',
            ball=ball_xml('<bsdf type="dielectric"/><ref name="interior" id="fog"/>'),
        ),
    ),
    "constant volume": (
        dict(
            integrator={"type": "volpath"},
            ball=ball(bsdf={"type": "null"}, interior={"type": "heterogeneous", "sigma_t": {"type": "constvolume", "value": 2.0}, "albedo": 0.5}),
        ),
        dict(
            integrator='<integrator type="volpath"/>',
            ball=ball_xml(
                """<bsdf type="null"/><medium type="heterogeneous" name="interior"><float name="albedo" value="0.5"/>
                  <volume type="constvolume" name="sigma_t"><float name="value" value="2"/></volume></medium>"""
            ),
        ),
    ),
    "lens": (
        dict(sensor={"type": "thinlens", "aperture_radius": 0.3, "focus_distance": 3.0, "to_world": LOOK, "film": FILM}),
        dict(sensor=sensor_xml("thinlens", '<float name="aperture_radius" value="0.3"/><float name="focus_distance" value="3"/>')),
    ),
    "orthographic": (
        dict(sensor={"type": "orthographic", "to_world": LOOK @ T().scale([2, 2, 1]), "film": FILM}),
        dict(sensor=sensor_xml("orthographic").replace("<lookat", '<scale x="2" y="2"/><lookat')),
    ),
    "film with filter and sampler": (
        dict(
            sensor={
                **PARTS["sensor"],
                "film": {"type": "hdrfilm", "width": 5, "height": 7, "filter": {"type": "gaussian", "stddev": 0.4}, "pixel_format": "rgba"},
                "sampler": {"type": "independent", "sample_count": 2, "seed": 5},
            }
        ),
        dict(
            sensor=f"""<sensor type="perspective"><float name="fov" value="40"/>{LOOK_XML}<film type="hdrfilm">
              <integer name="width" value="5"/><integer name="height" value="7"/><string name="pixel_format" value="rgba"/>
              <rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>
              <sampler type="independent"><integer name="sample_count" value="2"/><integer name="seed" value="5"/></sampler></sensor>"""
        ),
    ),
    "direct light": (
        dict(integrator={"type": "direct", "emitter_samples": 2, "bsdf_samples": 1}),
        dict(
            integrator="""<integrator type="direct"><integer name="emitter_samples" value="2"/>
              <integer name="bsdf_samples" value="1"/></integrator>"""
        ),
    ),
    "nested integrators": (
        dict(integrator={"type": "aov", "aovs": "dd:depth", "img": {"type": "path", "max_depth": 2}}),
        dict(
            integrator="""<integrator type="aov"><string name="aovs" value="dd:depth"/>
              <integrator type="path" name="img"><integer name="max_depth" value="2"/></integrator></integrator>"""
        ),
    ),
    "ambient occlusion": (dict(integrator={"type": "ao"}), dict(integrator='<integrator type="ao"/>')),
    "subsurface": (
        dict(integrator={"type": "volpath"}, ball=ball(inside={"type": "randomwalk", "mean_free_path": 0.2, "albedo": {"type": "rgb", "value": [0.8, 0.5, 0.4]}})),
        dict(
            integrator='<integrator type="volpath"/>',
            ball=ball_xml(
                """<subsurface type="randomwalk"><float name="mean_free_path" value="0.2"/>
                  <rgb name="albedo" value="0.8, 0.5, 0.4"/></subsurface>"""
            ),
        ),
    ),
}
PICTURES = {}


@pytest.mark.parametrize("name", PAIRS)
def test_dicts_are_their_xml(name):
    parts, xml = PAIRS[name]
    loaded, read = et.load_dict(scene(**parts)), et.load_string(scene_xml(**xml))
    PICTURES[name] = pixels(loaded)
    assert np.array_equal(PICTURES[name], pixels(read))
    assert (loaded.integrator, loaded.size, len(loaded.notes)) == (read.integrator, read.size, len(read.notes))
    # The text is the same scene again, and so is another integrator's picture.
    again = et.load_string(et.dict_to_xml(scene(**parts)))
    assert np.array_equal(PICTURES[name], pixels(again))


def test_all_pairs_differ():
    # Otherwise what they say would not matter to the pictures.
    if len(PICTURES) < len(PAIRS):
        pytest.skip("needs all pictures")
    assert len(PAIRS) >= 30
    assert len({picture.tobytes() for picture in PICTURES.values()}) == len(PAIRS)


def test_every_plugin_is_known_by_its_name():
    words = (ROOT / "docs/plugins.toml").read_text()
    found = re.findall(r'^class = "(\w+)"\nnames = \[(.*)\]', words, re.MULTILINE)
    plugins = [(kind, name) for kind, names in found for name in re.findall(r'"(\w+)"', names)]
    assert len(plugins) > 150
    for kind, name in plugins:
        # Two are of two classes; a grid of space may be any texture.
        kind = {("volume", "expression"): "texture", ("shape", "hair"): "bsdf"}.get((kind, name), kind)
        assert f'<{kind} type="{name}" name="x" id="x"/>' in et.dict_to_xml({"type": "scene", "x": {"type": name}})
    strands = {"type": "scene", "x": {"type": "hair", "filename": Path("a.txt")}}
    assert '<shape type="hair"' in et.dict_to_xml(strands) and 'value="a.txt"' in et.dict_to_xml(strands)


def test_options_render_a_dict_again():
    loaded = et.load_dict(scene())
    assert "<dict>, 8 × 6, path" in repr(loaded)
    other = et.render(loaded, spp=4, seed=1, integrator="direct", size=(6, 5))
    direct = et.load_string(scene_xml(integrator='<integrator type="direct"/>'))
    same = et.render(direct, spp=4, seed=1, size=(6, 5))
    with pytest.raises(et.SceneError, match=r"^sensor: error: `forward` waits for"):
        et.render(loaded, integrator="forward")
    assert other.size == (6, 5) and np.array_equal(other.numpy(), same.numpy())


def test_notes_have_key_paths():
    bright = np.full((2, 2, 3), 1.5, np.float32)
    notes = et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": bright})).notes
    assert len(notes) == 1 and notes[0].startswith("ball.bsdf.reflectance.data: note: ")


def with_bsdf(**bsdf):
    return scene(ball=ball(bsdf=bsdf))


def circular():
    bsdf = {"type": "twosided"}
    bsdf["inner"] = bsdf
    return scene(ball=ball(bsdf=bsdf))


MESH = {
    "type": "mesh",
    "vertices": np.array([[-1, 0, -1], [1, 0, -1], [0, 0.3, 1]], dtype=np.float32),
    "faces": np.array([[0, 1, 2]]),
}

# Dicts with mistakes, where and what.
BAD = {
    "misspelt plugin": (with_bsdf(type="difuse"), "ball.bsdf.type", "there is no plugin `difuse` (did you mean `diffuse`?)"),
    "another program's plugin": (with_bsdf(type="glass"), "ball.bsdf.type", "did you mean `dielectric`?"),
    "misspelt parameter": (scene(ball={"type": "sphere", "radus": 1}), "ball.radus", "did you mean `radius`?"),
    "refused value": (scene(ball=ball(radius=-1)), "ball.radius", "cannot be -1"),
    "wrong kind": (scene(ball=ball(radius="big")), "ball.radius", "must be a number, not a string"),
    "no type": (scene(ball={"radius": 1}), "ball", "the dict with the keys radius has no `type`"),
    "type is no string": (scene(ball={"type": 3}), "ball.type", "it is a string, not an int"),
    "None": (with_bsdf(type="diffuse", reflectance=None), "ball.bsdf.reflectance", "None can be no value of a scene"),
    "set": (scene(ball=ball(center={1, 2, 3})), "ball.center", "a set can be no value of a scene"),
    "texts for numbers": (scene(ball=ball(center=["1", "2", "3"])), "ball.center", "a list can be no value"),
    "key is no string": (scene(ball=ball(**{}) | {3: 4}), "ball", "the key 3 is no string"),
    "point in a key": (scene(**{"a.b": {"type": "sphere"}}), "a.b", "has no point"),
    "circle": (circular(), "ball.bsdf.inner", "the dict contains itself"),
    "no such reference": (with_bsdf(type="ref", id="cley"), "ball.bsdf", "there is no object with the id `cley`"),
    "id given twice": (scene(a={"type": "sphere", "id": "x"}, b={"type": "sphere", "id": "x"}), "b", "the id `x` is given twice"),
    "reference without id": (with_bsdf(type="ref"), "ball.bsdf", "a `ref` has an `id`"),
    "NaN in a matrix": (scene(ball=ball(to_world=np.full((4, 4), np.nan))), "ball.to_world", "`NaN` is not a finite number"),
    "singular matrix": (scene(ball=ball(to_world=np.diag([1, 1, 0, 1.0]))), "ball.to_world", "cannot be undone"),
    "matrix of 3 × 3": (scene(ball=ball(to_world=np.eye(3))), "ball.to_world", "a transform has 4 × 4 numbers"),
    "four numbers": (scene(ball=ball(center=[1, 2, 3, 4])), "ball.center", "an array of 4 can be no value of a scene"),
    "two numbers in a colour": (
        with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": [1, 2]}),
        "ball.bsdf.reflectance",
        "the value of `rgb` is three numbers or one, not an array of 2",
    ),
    "colour without value": (with_bsdf(type="diffuse", reflectance={"type": "rgb"}), "ball.bsdf.reflectance", "`rgb` has a `value`"),
    "descending wavelengths": (
        with_bsdf(type="diffuse", reflectance={"type": "spectrum", "value": [(500, 1), (400, 1)]}),
        "ball.bsdf.reflectance",
        "wavelengths must ascend",
    ),
    "missing file": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "filename": Path("nowhere.png")}),
        "ball.bsdf.reflectance.filename",
        "the file `nowhere.png` was not found",
    ),
    "picture of two channels": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": np.zeros((3, 4, 2))}),
        "ball.bsdf.reflectance.data",
        "not 3 × 4 × 2",
    ),
    "picture of int64": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": np.zeros((3, 4), int)}),
        "ball.bsdf.reflectance.data",
        "not of int64",
    ),
    "volume of two dimensions": (
        scene(ball={"type": "sdfgrid", "data": np.zeros((2, 2))}),
        "ball.data",
        "an array along z, y and x",
    ),
    "vertices in the plane": (scene(ball={**MESH, "vertices": np.zeros((3, 2))}), "ball.vertices", "N × 3, not 3 × 2"),
    "vertex that is not there": (scene(ball={**MESH, "faces": [[0, 1, 3]]}), "ball.faces", "face 0 has the vertex 3, but there are 3"),
    "faces of floats": (scene(ball={**MESH, "faces": [[0, 1, 2.0]]}), "ball.faces", "float64, not integers"),
    "normals of another mesh": (scene(ball={**MESH, "normals": np.ones((2, 3))}), "ball.normals", "2 rows for 3 vertices"),
    "infinite vertex": (scene(ball={**MESH, "vertices": np.full((3, 3), np.inf)}), "ball.vertices", "not finite"),
    "mesh without faces": (scene(ball={"type": "mesh", "vertices": MESH["vertices"]}), "ball.faces", "a mesh needs"),
    "no scene": ({"type": "sphere"}, "type", "the outermost dict is a scene"),
    "nothing": ({}, "", "the empty dict has no `type`"),
}


@pytest.mark.parametrize("name", BAD)
def test_mistakes_have_key_paths(name):
    wrong, key, words = BAD[name]
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(wrong)
    lines = str(caught.value).split("\n")
    assert [line for line in lines if line.startswith(f"{key or '<dict>'}: error: ") and words in line], lines
    found = [d for d in caught.value.diagnostics if d["key"] == key]
    assert found and found[0]["severity"] == "error"
    assert len(caught.value.diagnostics) == len(lines)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(scene(ball=ball(radius=None), floor={"type": "rectangl"}))
    assert [d["key"] for d in caught.value.diagnostics] == ["ball.radius", "floor.type"]
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(scene(ball=ball(radius=-2), lamp={"type": "point", "intens": 1.0}))
    assert [d["key"] for d in caught.value.diagnostics] == ["lamp.intens", "ball.radius"]
    with pytest.raises(TypeError):
        et.load_dict("scene")


def test_dollars_and_markup_are_text(tmp_path):
    folder = tmp_path / "a $b & <c>"
    folder.mkdir()
    pixel = np.full((1, 1, 3), 128, np.uint8)
    write_png(folder / 'd"e.png', pixel)
    reflectance = {"type": "bitmap", "filename": folder / 'd"e.png'}
    from_file = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance=reflectance)))
    from_array = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": pixel})))
    assert np.array_equal(from_file, from_array)
    found = scene(files={"type": "resources", "path": folder}, ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "bitmap", "filename": 'd"e.png'}}))
    assert np.array_equal(pixels(et.load_dict(found)), from_array)


def write_png(path, array):
    """A PNG file by the standard library alone: rows of unfiltered bytes."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, channels = array.shape
    rows = b"".join(b"\0" + row.tobytes() for row in array)
    colour = {1: 0, 3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_pfm(path, array):
    """A file of floats, bottom row first."""
    height, width, channels = array.shape
    kind = {1: "Pf", 3: "PF"}[channels]
    path.write_bytes(f"{kind}\n{width} {height}\n-1.0\n".encode() + array[::-1].astype("<f4").tobytes())


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("kind", ["uint8", "float32", "float64"])
@pytest.mark.parametrize("raw", [False, True])
def test_pictures_in_arrays_are_those_of_files(channels, kind, raw, tmp_path):
    rng = np.random.default_rng(channels)
    array = rng.integers(0, 256, (3, 5, channels), np.uint8) if kind == "uint8" else rng.uniform(0, 1, (3, 5, channels)).astype(kind)
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


def write_vol(path, array):
    z, y, x, channels = array.shape
    header = b"VOL\x03" + np.array([1, x, y, z, channels], "<i4").tobytes()
    path.write_bytes(header + np.array([0, 0, 0, 1, 1, 1], "<f4").tobytes() + array.astype("<f4").tobytes())


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
    with pytest.raises(et.SceneError, match=r"^ball\.bsdf\.reflectance\.data: error: an array does not stand in a text"):
        et.dict_to_xml(changed)
    # A dict is left as it was.
    assert changed["ball"]["bsdf"]["reflectance"]["data"] is array


def test_dicts_can_be_copied_and_are_left_alone():
    given = scene(ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.1, 0.2, 0.3]}}))
    before = copy.deepcopy(given)
    assert before["floor"]["to_world"] is not given["floor"]["to_world"]
    et.load_dict(given)
    assert given == before


def test_transforms():
    turned = T().translate([1, 2, 3]).rotate([0, 0, 2], 90).scale([2, 1, 1]).matrix
    assert turned @ [1, 0, 0, 1] == pytest.approx([1, 4, 3, 1])
    assert (T().translate([1, 2, 3]) @ T().rotate((0, 0, 1), 90)).matrix @ [1, 0, 0, 1] == pytest.approx([1, 3, 3, 1])
    assert T(turned).inverse().matrix @ turned == pytest.approx(np.eye(4))
    assert T().scale(3).matrix == pytest.approx(np.diag([3, 3, 3, 1]))
    frame = T().look_at(origin=[0, 0, 5], target=[0, 0, 0], up=[0, 1, 0]).matrix
    assert frame @ [0, 1, 1, 1] == pytest.approx([0, 1, 4, 1])
    assert eval(repr(T().scale(2)), {"etalon": et}).matrix == pytest.approx(np.diag([2, 2, 2, 1]))
    assert T().matrix.dtype == np.float64
    for wrong in [
        lambda: T(np.eye(3)),
        lambda: T().translate([1, 2]),
        lambda: T().rotate([0, 0, 0], 3),
        lambda: T().look_at([0, 0, 0], [0, 0, 0]),
        lambda: T().scale([1, 1, 0]).inverse(),
    ]:
        with pytest.raises(ValueError):
            wrong()


class Mitsubas:
    """As Mitsuba's transforms are: an object with a matrix."""

    def __init__(self, matrix):
        self.matrix = matrix


class Color3f(list):
    """As Mitsuba's colours are called."""


def test_objects_of_mitsuba_are_understood():
    moved = Mitsubas(T().translate([0.3, 0, 0]).matrix.tolist())
    ours = pixels(et.load_dict(scene(ball=ball(to_world=T().translate([0.3, 0, 0])))))
    assert np.array_equal(pixels(et.load_dict(scene(ball=ball(to_world=moved)))), ours)
    colour = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance=Color3f([0.9, 0.1, 0.1]))))
    named = with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": [0.9, 0.1, 0.1]})
    assert np.array_equal(colour, pixels(et.load_dict(named)))
    with pytest.raises(et.SceneError, match="ball.to_world: error: a transform has 4 × 4 numbers, not 2 × 2"):
        et.load_dict(scene(ball=ball(to_world=Mitsubas([[1, 0], [0, 1]]))))
