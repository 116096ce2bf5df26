"""What is written of a scene."""

import math
import runpy
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import pytest

np = pytest.importorskip("numpy")
bpy = pytest.importorskip("bpy")

import blender_export
from builders import ball, fresh, floor, lamp, material, place, picture, plain, shader, sheet, texture
from test_files import read_ply


def exported(folder):
    """The scene's elements and the notes."""
    notes = blender_export.export(folder)
    return tree.parse(folder / "scene.xml").getroot(), notes


def value(element, name):
    """A parameter's value."""
    return element.find(f"*[@name='{name}']").get("value")


def test_what_is_not_read_is_named(tmp_path):
    fresh()
    sheet(1.0, 1.0, material(lambda nodes: shader(nodes, "BsdfDiffuse", Color=shader(nodes, "TexNoise")), name="rusty"))
    sheet(1.0, 1.0, plain("BsdfToon", Color=(0.1, 0.2, 0.3)))
    scene, notes = exported(tmp_path)
    assert len(notes) == 2
    assert "material rusty, node Noise Texture" in notes[0] and "Color has its own value (0.8, 0.8, 0.8) instead" in notes[0]
    assert "node Toon BSDF" in notes[1] and "diffuse" in notes[1]
    assert value(scene.findall("bsdf")[1][0], "reflectance").startswith("0.1")


def test_modifiers_and_hidden_objects_are_those_of_renders(tmp_path):
    fresh()
    seen = floor()
    levels = seen.modifiers.new("levels", "SUBSURF")
    levels.subdivision_type, levels.levels, levels.render_levels = "SIMPLE", 0, 2
    hidden, shown = floor(), ball(plain("BsdfDiffuse"))
    hidden.hide_render, shown.hide_viewport = True, True
    scene, _ = exported(tmp_path)
    files = [value(shape, "filename") for shape in scene.findall("shape")]
    assert files == ["meshes/sheet.ply", "meshes/Sphere.ply"]
    assert len(read_ply(tmp_path / files[0])[2]) == 2 * 16
    assert bpy.context.scene.render.engine != "ETALON_EXPORT"


def test_copies_are_instances_unless_they_shine(tmp_path):
    fresh()
    first, lit = floor(), sheet(1.0, 1.0, plain("Emission"))
    for thing in (first, lit):
        place(thing.data, (0.0, 0.0, 3.0))
    scene, _ = exported(tmp_path)
    assert sorted(shape.get("type") for shape in scene.findall("shape")) == ["instance", "instance", "ply", "ply", "shapegroup"]
    assert len(list((tmp_path / "meshes").iterdir())) == 2
    matrices = [shape.find("transform/matrix").get("value").split() for shape in scene.findall("shape[@type='instance']")]
    heights = {matrix[11] for matrix in matrices}
    assert heights == {"0", "3"}


def test_materials_split_a_mesh(tmp_path):
    fresh()
    thing = ball(plain("BsdfDiffuse"))
    thing.data.materials.append(plain("BsdfTransparent"))
    thing.data.materials.append(plain("Emission"))
    for face in thing.data.polygons:
        face.material_index = face.index % 3
    scene, _ = exported(tmp_path)
    shapes = scene.findall("shape")
    assert len(shapes) == 2  # what is invisible is not there
    assert [shape.find("emitter") is not None for shape in shapes] == [False, True]
    counts = [len(read_ply(tmp_path / value(shape, "filename"))[2]) for shape in shapes]
    assert abs(counts[0] - counts[1]) < 60 and sum(counts) < 2 * 48 * 24


def test_groups_are_looked_into(tmp_path):
    fresh()
    group = bpy.data.node_groups.new("group", "ShaderNodeTree")
    group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    ends = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    group.links.new(shader(group, "BsdfDiffuse", Color=ends[0].outputs[0]), ends[1].inputs[0])

    def use(nodes):
        node = nodes.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.inputs["Tint"].default_value = (0.25, 0.5, 0.75, 1.0)
        return node.outputs[0]

    sheet(1.0, 1.0, material(use))
    scene, notes = exported(tmp_path)
    assert value(scene.find("bsdf/bsdf"), "reflectance") == "0.25, 0.5, 0.75" and notes == []


def test_numbers_of_textures_are_linear_and_one_file_serves_all_uses(tmp_path):
    fresh()
    image = picture("image", 4, 4, is_float=False)
    image.pixels.foreach_set(np.tile(np.float32([0.5, 0.5, 0.5, 1.0]), 16))

    def build(nodes):
        colour = texture(nodes, image).outputs["Color"]
        return shader(nodes, "BsdfPrincipled", Roughness=colour, Metallic=colour)

    sheet(1.0, 1.0, material(build))
    exported(tmp_path)
    (file,) = (tmp_path / "textures").iterdir()
    linear = ((128 / 255 + 0.055) / 1.055) ** 2.4
    assert int.from_bytes(file.read_bytes()[-2:], "big") == pytest.approx(65535 * linear, abs=1.0)


def test_lamps_that_would_be_seen(tmp_path):
    """Blender's camera does not see lamps: all are hidden if nothing else shines, else what is in the picture is sharp."""
    fresh()
    floor()
    lamp("POINT", shadow_soft_size=0.2)
    scene, notes = exported(tmp_path)
    assert value(scene.find("integrator"), "hide_emitters") == "true" and notes == []
    assert scene.find("shape[@type='sphere']") is not None
    fresh((0.5, 0.5, 0.5))
    lamp("POINT", shadow_soft_size=0.2, location=(0.5, 0.0, 1.0))
    lamp("POINT", shadow_soft_size=0.2, location=(0.0, 0.0, 50.0)).name = "far above"
    scene, notes = exported(tmp_path)
    assert scene.find("integrator/boolean") is None
    assert len(notes) == 1 and "light point" in notes[0]
    assert scene.find("emitter[@type='point']") is not None and len(scene.findall("shape[@type='sphere']")) == 1


def test_film_and_samples(tmp_path):
    fresh()
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 200, 100, 25
    bpy.context.scene.cycles.samples, bpy.context.scene.cycles.max_bounces = 7, 3
    render.film_transparent = True
    scene, _ = exported(tmp_path)
    film = scene.find("sensor/film")
    assert [value(film, name) for name in ("width", "height", "pixel_format")] == ["50", "25", "rgba"]
    assert value(scene.find("sensor/sampler"), "sample_count") == "7" and value(scene.find("integrator"), "max_depth") == "4"


def test_scenes_without_a_camera_and_panoramas_are_refused(tmp_path):
    fresh()
    bpy.context.scene.camera.data.type = "PANO"
    with pytest.raises(ValueError, match="camera camera: panoramas are not exported"):
        blender_export.export(tmp_path)
    bpy.context.scene.camera = None
    with pytest.raises(ValueError, match="no camera"):
        blender_export.export(tmp_path)


def test_command_lines(tmp_path, monkeypatch):
    fresh()
    floor()
    lamp("AREA", rotation=(math.pi, 0.0, 0.0))
    file, script = str(tmp_path / "a.blend"), blender_export.__file__
    bpy.ops.wm.save_as_mainfile(filepath=file)
    for name, command in {
        "in-blender": ["blender", "--background", file, "--python", script, "--", str(tmp_path / "in-blender")],
        "by-python": [script, file, str(tmp_path / "by-python")],
    }.items():
        monkeypatch.setattr(sys, "argv", command)
        runpy.run_path(script, run_name="__main__")
        assert (tmp_path / name / "scene.xml").exists()
    assert Path(tmp_path / "in-blender/scene.xml").read_text() == Path(tmp_path / "by-python/scene.xml").read_text()
    monkeypatch.setattr(sys, "argv", [script, file])
    with pytest.raises(SystemExit, match="usage"):
        runpy.run_path(script, run_name="__main__")


@pytest.mark.parametrize(
    "kind, width, expected",
    [("BOX", 1.0, None), ("BOX", 2.0, "1"), ("GAUSSIAN", 2.0, "0.5"), ("BLACKMAN_HARRIS", 1.5, "0.4155")],
)
def test_filters(tmp_path, kind, width, expected):
    fresh()
    settings = bpy.context.scene.cycles
    settings.pixel_filter_type, settings.filter_width = kind, width
    scene, _ = exported(tmp_path)
    found = scene.find("sensor/film/rfilter")
    assert found.get("type") == ("box" if kind == "BOX" else "gaussian")
    assert [child.get("value") for child in found] == ([] if expected is None else [expected])


def test_a_texture_may_be_used_twice(tmp_path):
    """Holes by an image: what is not there does not shine, either."""
    fresh()

    def build(nodes):
        alpha = texture(nodes, picture("holes")).outputs["Alpha"]
        return shader(nodes, "BsdfPrincipled", Alpha=alpha, Emission_Strength=2.0, Emission_Color=(1.0, 0.5, 0.25))

    sheet(1.0, 1.0, material(build))
    scene, notes = exported(tmp_path)
    opacity = scene.find("bsdf[@type='mask']/texture[@name='opacity']")
    light = scene.find("shape/emitter/spectrum[@name='radiance']/texture")
    assert light.get("type") == "multiply" and notes == []
    for parent in (opacity, light):
        assert len(list(parent.iter("texture"))) > 1 and "holes-a.pfm" in tree.tostring(parent, encoding="unicode")
    assert value(light, "a") == "2, 1, 0.5" and light[1].get("name") == "b"


def test_one_layer_is_exported(tmp_path):
    """The active one, though another sees less."""
    fresh()
    part = bpy.data.collections.new("part")
    bpy.context.scene.collection.children.link(part)
    thing = floor()
    bpy.context.scene.collection.objects.unlink(thing)
    part.objects.link(thing)
    bpy.context.scene.view_layers.new("without").layer_collection.children["part"].exclude = True
    scene, _ = exported(tmp_path)
    assert len(scene.findall("shape")) == 1


def test_what_has_no_like_is_still_rendered(tmp_path):
    """A flat object, glass of the index of the air, an object without faces."""
    fresh()
    floor().scale = (1.0, 1.0, 0.0)
    ball(plain("BsdfGlass", IOR=1.0, Roughness=0.5))
    place(bpy.data.meshes.new("nothing"), (0.0, 0.0, 0.0))
    scene, notes = exported(tmp_path)
    assert notes == ["object sheet: its scale makes it flat, which is left out"]
    assert scene.find("bsdf").get("type") == "thindielectric" and len(scene.findall("shape")) == 1
