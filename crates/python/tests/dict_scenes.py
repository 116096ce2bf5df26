"""Small scenes as dicts, and the same as XML."""

import etalon as et
import numpy as np
import pytest

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


def assert_refused(act, key, words):
    """An error at this path of keys says these words."""
    with pytest.raises(et.SceneError) as caught:
        act()
    lines = str(caught.value).split("\n")
    assert [line for line in lines if line.startswith(f"{key}: error: ") and words in line], lines


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


def with_bsdf(**bsdf):
    return scene(ball=ball(bsdf=bsdf))


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
        dict(
            ball={
                "type": "cylinder",
                "p0": [0, 0, -1],
                "p1": np.array([0, 0.5, 1]),
                "radius": 0.5,
                "flip_normals": True,
            }
        ),
        dict(ball="""<shape type="cylinder"><point name="p0" value="0, 0, -1"/><point name="p1" value="0, 0.5, 1"/>
              <float name="radius" value="0.5"/><boolean name="flip_normals" value="true"/></shape>"""),
    ),
    "matrix in lists": (
        dict(ball={"type": "disk", "to_world": [[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0.5], [0, 0, 0, 1]]}),
        dict(ball="""<shape type="disk"><transform name="to_world"><matrix value="1 0 0 0 0 0 -1 0 0 1 0 0.5 0 0 0 1"/>
              </transform></shape>"""),
    ),
    "instances": (
        dict(
            group={
                "type": "shapegroup",
                "one": {"type": "sphere", "radius": 0.3},
                "two": {"type": "cube", "to_world": T().scale(0.2)},
            },
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
        dict(
            ball=ball(
                bsdf={
                    "type": "diffuse",
                    "reflectance": {"type": "spectrum", "value": [(400, 0.1), (550, 0.9), (700, 0.2)]},
                }
            )
        ),
        dict(
            ball=ball_xml(
                '<bsdf type="diffuse"><spectrum name="reflectance" value="400:0.1, 550:0.9, 700:0.2"/></bsdf>'
            )
        ),
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
        dict(
            ball=ball(
                bsdf={"type": "roughconductor", "material": "Au", "alpha": np.float64(0.2), "distribution": "ggx"}
            )
        ),
        dict(
            ball=ball_xml(
                """<bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.2"/>
                  <string name="distribution" value="ggx"/></bsdf>"""
            )
        ),
    ),
    "plastic": (
        dict(
            ball=ball(
                bsdf={
                    "type": "plastic",
                    "diffuse_reflectance": {"type": "rgb", "value": np.array([0.1, 0.3, 0.4])},
                    "nonlinear": True,
                }
            )
        ),
        dict(ball=ball_xml("""<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1, 0.3, 0.4"/>
                  <boolean name="nonlinear" value="true"/></bsdf>""")),
    ),
    "principled": (
        dict(
            ball=ball(
                material={
                    "type": "principled",
                    "base_color": {"type": "rgb", "value": [1, 0.5, 0]},
                    "metallic": 0.7,
                    "roughness": 0.4,
                }
            )
        ),
        dict(ball=ball_xml("""<bsdf type="principled"><rgb name="base_color" value="1, 0.5, 0"/>
                  <float name="metallic" value="0.7"/>
                  <float name="roughness" value="0.4"/></bsdf>""")),
    ),
    "blend of two sides": (
        dict(
            ball=ball(
                bsdf={
                    "type": "twosided",
                    "both": {
                        "type": "blendbsdf",
                        "weight": 0.3,
                        "first": {"type": "diffuse"},
                        "second": {"type": "conductor"},
                    },
                }
            )
        ),
        dict(ball=ball_xml("""<bsdf type="twosided"><bsdf type="blendbsdf"><float name="weight" value="0.3"/>
                  <bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></bsdf>""")),
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
        dict(
            ball=ball(
                bsdf={"type": "diffuse", "reflectance": {"type": "expression", "k": 9, "value": "0.5 + 0.4*sin(k*x)"}}
            )
        ),
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
        dict(ball=ball_xml("""<emitter type="area"><spectrum type="blackbody" name="radiance">
                  <float name="temperature" value="3000"/>
                  </spectrum></emitter>""")),
    ),
    "spot": (
        dict(
            lamp={
                "type": "spot",
                "to_world": T().look_at([1, -2, 3], [0, 0, 0]),
                "cutoff_angle": 15,
                "intensity": {"type": "d65", "scale": 40},
            }
        ),
        dict(lamp="""<emitter type="spot">
              <transform name="to_world"><lookat origin="1, -2, 3" target="0, 0, 0"/></transform>
              <float name="cutoff_angle" value="15"/>
              <spectrum type="d65" name="intensity"><float name="scale" value="40"/></spectrum></emitter>"""),
    ),
    "directional": (
        dict(lamp={"type": "directional", "direction": [1, 1, -1], "irradiance": {"type": "rgb", "value": 2}}),
        dict(lamp="""<emitter type="directional"><vector name="direction" value="1, 1, -1"/>
              <rgb name="irradiance" value="2"/></emitter>"""),
    ),
    "sky": (
        dict(light={"type": "sunsky", "turbidity": 4.5, "sun_scale": 0, "to_world": T().rotate([1, 0, 0], 90)}),
        dict(light="""<emitter type="sunsky"><float name="turbidity" value="4.5"/><float name="sun_scale" value="0"/>
              <transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>"""),
    ),
    "fog inside": (
        dict(
            integrator={"type": "volpath", "max_depth": 6},
            ball=ball(bsdf={"type": "null"}, interior={**FOG, "phase": {"type": "hg", "g": 0.6}}),
        ),
        dict(
            integrator='<integrator type="volpath"><integer name="max_depth" value="6"/></integrator>',
            ball=ball_xml(f"""<bsdf type="null"/><medium type="homogeneous" name="interior">{FOG_XML}
                  <phase type="hg"><float name="g" value="0.6"/></phase></medium>"""),
        ),
    ),
    "medium by reference": (
        dict(
            integrator={"type": "volpath"},
            fog=FOG,
            ball=ball(bsdf={"type": "dielectric"}, interior={"type": "ref", "id": "fog"}),
        ),
        dict(
            integrator='<integrator type="volpath"/>',
            fog=f'<medium type="homogeneous" id="fog">{FOG_XML}</medium>',
            ball=ball_xml('<bsdf type="dielectric"/><ref name="interior" id="fog"/>'),
        ),
    ),
    "constant volume": (
        dict(
            integrator={"type": "volpath"},
            ball=ball(
                bsdf={"type": "null"},
                interior={"type": "heterogeneous", "sigma_t": {"type": "constvolume", "value": 2.0}, "albedo": 0.5},
            ),
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
        dict(
            sensor={"type": "thinlens", "aperture_radius": 0.3, "focus_distance": 3.0, "to_world": LOOK, "film": FILM}
        ),
        dict(
            sensor=sensor_xml(
                "thinlens", '<float name="aperture_radius" value="0.3"/><float name="focus_distance" value="3"/>'
            )
        ),
    ),
    "orthographic": (
        dict(sensor={"type": "orthographic", "to_world": LOOK @ T().scale([2, 2, 1]), "film": FILM}),
        dict(sensor=sensor_xml("orthographic").replace("<lookat", '<scale x="2" y="2"/><lookat')),
    ),
    "film with filter and sampler": (
        dict(
            sensor={
                **PARTS["sensor"],
                "film": {
                    "type": "hdrfilm",
                    "width": 5,
                    "height": 7,
                    "filter": {"type": "gaussian", "stddev": 0.4},
                    "pixel_format": "rgba",
                },
                "sampler": {"type": "independent", "sample_count": 2, "seed": 5},
            }
        ),
        dict(sensor=f"""<sensor type="perspective"><float name="fov" value="40"/>{LOOK_XML}<film type="hdrfilm">
              <integer name="width" value="5"/><integer name="height" value="7"/>
              <string name="pixel_format" value="rgba"/>
              <rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>
              <sampler type="independent"><integer name="sample_count" value="2"/><integer name="seed" value="5"/></sampler>
              </sensor>"""),
    ),
    "direct light": (
        dict(integrator={"type": "direct", "emitter_samples": 2, "bsdf_samples": 1}),
        dict(integrator="""<integrator type="direct"><integer name="emitter_samples" value="2"/>
              <integer name="bsdf_samples" value="1"/></integrator>"""),
    ),
    "nested integrators": (
        dict(integrator={"type": "aov", "aovs": "dd:depth", "img": {"type": "path", "max_depth": 2}}),
        dict(integrator="""<integrator type="aov"><string name="aovs" value="dd:depth"/>
              <integrator type="path" name="img"><integer name="max_depth" value="2"/></integrator></integrator>"""),
    ),
    "ambient occlusion": (dict(integrator={"type": "ao"}), dict(integrator='<integrator type="ao"/>')),
    "motion": (
        dict(
            ball=ball(to_world={"type": "animation", "keys": [(0, T()), (1.0, T().translate([1, 0, 0]))]}),
            light={
                "type": "constant",
                "radiance": {"type": "animation", "keys": [(0, {"type": "rgb", "value": [1, 0, 0]})]},
            },
        ),
        dict(
            ball=ball_xml(
                """<animation name="to_world"><transform time="0"/><transform time="1"><translate x="1"/></transform>
                  </animation>"""
            ),
            light="""<emitter type="constant"><animation name="radiance"><rgb time="0" value="1, 0, 0"/></animation>
              </emitter>""",
        ),
    ),
    "subsurface": (
        dict(
            integrator={"type": "volpath"},
            ball=ball(
                inside={
                    "type": "randomwalk",
                    "mean_free_path": 0.2,
                    "albedo": {"type": "rgb", "value": [0.8, 0.5, 0.4]},
                }
            ),
        ),
        dict(
            integrator='<integrator type="volpath"/>',
            ball=ball_xml("""<subsurface type="randomwalk"><float name="mean_free_path" value="0.2"/>
                  <rgb name="albedo" value="0.8, 0.5, 0.4"/></subsurface>"""),
        ),
    ),
}
