"""Exported scenes have the same means in Etalon as in Cycles: over the picture, and over each of 4 × 4 tiles.

Both render 256 samples of a fixed seed, which leaves about 0.02 % of the means of pictures lit by lamps. Bounds are near what was
measured, and far below any wrong factor: 2, π, 4, an exchanged axis, another curve of colours. Light is neutral where colours
must agree: a spectral renderer multiplies spectra, not their colours.
"""

import math
import os

import pytest

np = pytest.importorskip("numpy")
bpy = pytest.importorskip("bpy")
if not os.environ.get("ETALON_BINARY"):
    pytest.skip("ETALON_BINARY names no binary of Etalon", allow_module_level=True)

from builders import ball, background, fresh, floor, lamp, material, picture, plain, shader, sheet, sun, texture
from renders import both

SKY = (0.3, 0.3, 0.3)
NEW = pytest.mark.skipif(bpy.app.version < (5, 0), reason="Cycles had another one before Blender 5.0")


def agree(folder, of_all, of_tiles, **options):
    """Holds the means to these relative bounds, tiles in what the whole picture has in the mean; returns the notes."""
    theirs, ours, notes = both(folder, **options)
    assert ours.shape == theirs.shape
    whole = np.abs(ours.mean((0, 1)) / theirs.mean((0, 1)) - 1.0)
    assert whole.max() <= of_all, f"means differ by {whole}"
    height, width = theirs.shape[:2]
    tiles = [picture.reshape(4, height // 4, 4, width // 4, 3).mean((1, 3, 4)) for picture in (theirs, ours)]
    worst = np.abs(tiles[1] - tiles[0]).max() / theirs.mean()
    assert worst <= of_tiles, f"a tile differs by {worst}"
    return notes


LAMPS = {
    "point": dict(kind="POINT", energy=100.0),
    "point, as watts per square metre": dict(kind="POINT", energy=100.0, normalize=False),
    "point, two stops more": dict(kind="POINT", energy=100.0, exposure=2.0),
    "ball": dict(kind="POINT", energy=100.0, shadow_soft_size=0.2, use_soft_falloff=False),
    "ball, as watts per square metre": dict(
        kind="POINT", energy=100.0, shadow_soft_size=0.2, use_soft_falloff=False, normalize=False
    ),
    "spot": dict(kind="SPOT", energy=100.0, spot_size=math.radians(80), spot_blend=0.3),
    "wide spot": dict(kind="SPOT", energy=100.0, spot_size=math.radians(150), spot_blend=1.0),
    "square": dict(kind="AREA", energy=100.0, size=1.0),
    "rectangle": dict(kind="AREA", energy=100.0, shape="RECTANGLE", size=2.0, size_y=0.3),
    "disk": dict(kind="AREA", energy=100.0, shape="DISK", size=1.0),
    "ellipse": dict(kind="AREA", energy=100.0, shape="ELLIPSE", size=0.5, size_y=1.5, normalize=False),
    "sun": dict(kind="SUN", energy=3.0, angle=0.0),
    "sun of half a degree": dict(kind="SUN", energy=3.0, angle=math.radians(0.5)),
    "sun of 40 degrees": dict(kind="SUN", energy=3.0, angle=math.radians(40)),
    "sun of 40 degrees, as radiance": dict(kind="SUN", energy=3.0, angle=math.radians(40), normalize=False),
}


@pytest.mark.parametrize("name", LAMPS)
def test_lamps(tmp_path, name):
    """A lamp over a matte floor, which is in its own shape invisible."""
    fresh()
    floor()
    if not {"normalize", "exposure"} & LAMPS[name].keys() <= set(dir(bpy.data.lights.new("any", "POINT"))):
        pytest.skip("this Blender has no such setting")
    lamp(**LAMPS[name])
    assert agree(tmp_path, 0.002, 0.005) == []


def test_soft_falloff(tmp_path):
    """Blender's default for balls is a disk that looks at what it lights: here 0.6 % darker, 2 % right below."""
    fresh()
    floor()
    lamp("POINT", energy=100.0, shadow_soft_size=0.2)
    agree(tmp_path, 0.01, 0.03)


def test_emission_and_nothing_else(tmp_path):
    """What shines and fills the picture is exact."""
    fresh()
    sheet(99.0, 99.0, plain("Emission", Color=(0.9, 0.5, 0.1), Strength=3.0))
    agree(tmp_path, 0.0002, 0.0002)


def test_matte_default_cube(tmp_path):
    """Blender's first scene without its gloss."""
    bpy.ops.wm.read_factory_settings()
    bpy.data.lights["Light"].use_soft_falloff = False
    inputs = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs
    inputs["Specular IOR Level"].default_value = 0.0
    assert agree(tmp_path, 0.002, 0.01) == []


def test_default_cube(tmp_path):
    """Blender's first scene: its plastic loses more light between its layers than Etalon's: 4 % of the cube's brightest side."""
    bpy.ops.wm.read_factory_settings()
    assert agree(tmp_path, 0.02, 0.12) == []


def test_textures(tmp_path):
    """An image, turned and stretched."""
    fresh()
    mapping = dict(Location=(0.2, 0.1, 0.0), Rotation=(0.0, 0.0, 0.5), Scale=(2.0, 3.0, 1.0))
    image = picture("image")
    sheet(4.0, 2.0, material(lambda tree: shader(tree, "BsdfDiffuse", Color=texture(tree, image, **mapping).outputs[0])))
    sun()
    assert agree(tmp_path, 0.002, 0.004) == []


def test_textures_of_bytes(tmp_path):
    """sRGB in bytes; without interpolation, which Cycles does before it decodes."""
    fresh()
    image = picture("image", is_float=False)
    sheet(4.0, 2.0, material(lambda tree: shader(tree, "BsdfDiffuse", Color=texture(tree, image, "Closest").outputs[0])))
    sun()
    assert agree(tmp_path, 0.002, 0.004) == []
    assert (tmp_path / "textures/image.png").exists()


@pytest.mark.parametrize("interpolation, of_tiles", [("LINEAR", 0.01), ("EASE", 0.01), ("CONSTANT", 0.05)])
def test_ramps_of_colours(tmp_path, interpolation, of_tiles):
    """Colours by the luminance of an image; Cycles has a table of 256, which moves steps a little."""
    fresh()

    def build(tree):
        position = texture(tree, picture("image", 256, 128)).outputs[0]
        ramp = tree.nodes.new("ShaderNodeValToRGB")
        ramp.color_ramp.interpolation = interpolation
        ramp.color_ramp.elements.new(0.4).color = (0.8, 0.2, 0.1, 1.0)
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[2].position = 0.2, 0.7
        ramp.color_ramp.elements[0].color = (0.1, 0.3, 0.6, 1.0)
        tree.links.new(position, ramp.inputs[0])
        return shader(tree, "BsdfDiffuse", Color=ramp.outputs["Color"])

    sheet(4.0, 2.0, material(build))
    sun()
    assert agree(tmp_path, 0.01, of_tiles) == []


def test_shining_textures(tmp_path):
    """An image that emits; its white is D65."""
    fresh()
    image = picture("image")
    sheet(4.0, 2.0, material(lambda tree: shader(tree, "Emission", Color=texture(tree, image).outputs[0], Strength=3.0)))
    assert agree(tmp_path, 0.002, 0.004) == []


@NEW
def test_bump(tmp_path):
    """Heights in metres."""
    fresh()

    def build(tree):
        heights = texture(tree, picture("heights")).outputs[0]
        return shader(tree, "BsdfDiffuse", Normal=shader(tree, "Bump", Height=heights, Distance=0.5, Strength=1.0))

    sheet(4.0, 2.0, material(build))
    sun()
    assert agree(tmp_path, 0.01, 0.03) == []


MATERIALS = {  # of the ball: what it is made of, and the bounds of the means of all and of tiles
    "glass": (dict(kind="BsdfPrincipled", Transmission_Weight=1.0, Roughness=0.0), 0.002, 0.004),
    "tinted glass": (dict(kind="BsdfGlass", Color=(0.7, 0.7, 0.7), Roughness=0.0, IOR=1.4), 0.002, 0.004),
    "plastic": (dict(kind="BsdfPrincipled", Base_Color=(0.2, 0.2, 0.2), Roughness=0.2), 0.01, 0.03),
    "metal": (dict(kind="BsdfPrincipled", Base_Color=(0.7, 0.7, 0.7), Metallic=1.0, Roughness=0.25), 0.01, 0.03),
    "mirror": (dict(kind="BsdfAnisotropic", Color=(0.7, 0.7, 0.7), Roughness=0.0), 0.002, 0.005),
    "half there": (dict(kind="BsdfPrincipled", Alpha=0.3), 0.005, 0.02),
    "paper": (dict(kind="BsdfTranslucent", Color=(0.7, 0.7, 0.7)), 0.002, 0.005),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_materials(tmp_path, name):
    """A ball on a floor, in the sun."""
    inputs, of_all, of_tiles = MATERIALS[name]
    fresh(SKY)
    floor()
    ball(plain(**inputs))
    sun()
    assert agree(tmp_path, of_all, of_tiles) == []


@NEW
def test_rough_diffuse(tmp_path):
    """Clay, as a ball in the sun."""
    fresh(SKY)
    floor()
    ball(plain("BsdfDiffuse", Color=(0.7, 0.7, 0.7), Roughness=0.7))
    sun()
    assert agree(tmp_path, 0.01, 0.04) == []


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE"])
def test_sky_of_an_image(tmp_path, kind):
    """A turned environment, in a mirror, on a floor and behind them."""
    fresh()
    tree = bpy.context.scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexEnvironment")
    sky.image = picture("sky", 256, 128)
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.vector_type, mapping.inputs["Rotation"].default_value = kind, (0.3, 0.5, 1.0)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], sky.inputs["Vector"])
    tree.links.new(sky.outputs["Color"], background().inputs["Color"])
    background().inputs["Strength"].default_value = 1.5
    sheet(3.0, 3.0, plain("BsdfDiffuse", Color=(0.6, 0.6, 0.6)))
    ball(plain("BsdfAnisotropic", Color=(0.9, 0.9, 0.9), Roughness=0.0))
    assert agree(tmp_path, 0.01, 0.02) == []


CAMERAS = {
    "shifted": dict(shift_x=0.15, shift_y=-0.1),
    "fit to the height": dict(sensor_fit="VERTICAL", sensor_height=18.0),
    "parallel": dict(type="ORTHO", ortho_scale=4.5, shift_x=0.1, shift_y=0.05),
}


@pytest.mark.parametrize("size", [(64, 48), (36, 64)])
@pytest.mark.parametrize("name", CAMERAS)
def test_cameras(tmp_path, name, size):
    """A picture that has no symmetry, seen in several ways."""
    fresh(SKY)
    sheet(4.0, 2.0, material(lambda tree: shader(tree, "BsdfDiffuse", Color=texture(tree, picture("image")).outputs[0])))
    sun()
    for setting, value in CAMERAS[name].items():
        setattr(bpy.context.scene.camera.data, setting, value)
    assert agree(tmp_path, 0.003, 0.01, size=size) == []


def test_lens(tmp_path):
    """What is out of focus, by a camera that is scaled, which changes nothing."""
    fresh()
    bpy.context.scene.camera.scale = (2.0, 2.0, 2.0)
    lens = bpy.context.scene.camera.data.dof
    lens.use_dof, lens.focus_distance, lens.aperture_fstop = True, 3.0, 0.05
    sheet(2.0, 1.0, plain("Emission", Color=(1.0, 1.0, 1.0), Strength=1.0))
    agree(tmp_path, 0.005, 0.03)
