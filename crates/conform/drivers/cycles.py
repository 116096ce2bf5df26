"""Driver: Cycles, by the module `bpy` of Blender 5.

Facts that it rests on: an emission's strength is radiance; a point lamp of power P has the intensity P/4π and, with a radius
r and without soft falloff, is a true sphere of the radiance P/4π²r²; a spot has P/4π too, whatever its cone; a sun's strength
is irradiance. There are no exact spheres but lamps: a black sphere that shines becomes one, all others become fine meshes of
the same area. The width of GGX facets is the square of a roughness (kernel/svm/closure.h); they hide each other by their height
(kernel/closure/bsdf_microfacet.h). A spot's blend is a smooth step in the cosine (kernel/light/spot.h).
"""

import math

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import bpy
import numpy as np
from mathutils import Matrix


def node(tree, kind, inputs=None, output=0, **options):
    """An output of a new shader node with these options; its inputs are values or outputs of other nodes."""
    new = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in options.items():
        setattr(new, name, value)
    for name, value in (inputs or {}).items():
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, new.inputs[name])
        else:
            new.inputs[name].default_value = value
    return new.outputs[output]


def grey(value):
    """A colour."""
    return (value, value, value, 1.0)


def scattering(tree, material):
    """How a material scatters light, as a shader."""
    match material:
        case {"kind": "diffuse", "reflectance": rho}:
            return node(tree, "BsdfDiffuse", {"Color": grey(rho), "Roughness": 0.0})
        case {"kind": "mirror", "reflectance": rho}:
            return node(tree, "BsdfAnisotropic", {"Color": grey(rho), "Roughness": 0.0})
        case {"kind": "rough_conductor", "masking": "separable"}:
            raise Unsupported("facets hide each other by their height")
        case {"kind": "conductor" | "rough_conductor", "n": n, "k": k}:
            inputs = {"IOR": [n] * 3, "Extinction": [k] * 3, "Roughness": math.sqrt(material.get("alpha", 0.0))}
            return node(tree, "BsdfMetallic", inputs, fresnel_type="PHYSICAL_CONDUCTOR", distribution="GGX")
        case {"kind": "glass", "n": n}:
            return node(tree, "BsdfGlass", {"Color": grey(1.0), "IOR": n, "Roughness": 0.0})
        case {"kind": "nothing"}:
            return node(tree, "BsdfTransparent", {"Color": grey(1.0)})
    raise protocol.unknown("material", material)


def emission(tree, radiance):
    """A shader that emits from the outer side only."""
    front, back = (node(tree, "Emission", {"Strength": strength}) for strength in (radiance, 0.0))
    return node(tree, "MixShader", {0: node(tree, "NewGeometry", output="Backfacing"), 1: front, 2: back})


def material(item):
    """The material of an object: what it scatters, what it emits, and what is inside."""
    new = bpy.data.materials.new("material")
    new.use_nodes = True
    tree = new.node_tree
    tree.nodes.clear()
    end = tree.nodes.new("ShaderNodeOutputMaterial").inputs
    radiance, medium = item["emitted_radiance"], item["interior"]
    shader = scattering(tree, item["material"])
    if radiance:
        shader = node(tree, "AddShader", {0: shader, 1: emission(tree, radiance)})
    if item["material"]["kind"] != "nothing" or not medium:  # the border of a medium has none, a void body a clear one
        tree.links.new(shader, end["Surface"])
    if medium:
        absorbed, scattered = [medium["absorption_per_m"]] * 3, [medium["scattering_per_m"]] * 3
        inputs = {"Absorption Coefficients": absorbed, "Scatter Coefficients": scattered}
        tree.links.new(node(tree, "VolumeCoefficients", inputs), end["Volume"])
    return new


def add(data):
    """Puts a lamp, a mesh or a camera into the scene."""
    thing = bpy.data.objects.new("object", data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def aim(thing, origin, forward, up=None):
    """Turns a thing that looks along its −z axis."""
    right, up, forward = shapes.frame(forward, up)
    thing.matrix_world = Matrix(shapes.placed([right, up, -forward], origin))


def lamp(kind, **settings):
    """A lamp of no extent, or of what `settings` say."""
    data = bpy.data.lights.new("lamp", kind)
    if kind != "SUN":
        data.shadow_soft_size, data.use_soft_falloff = 0.0, False
    for name, value in settings.items():
        setattr(data, name, value)
    return add(data)


def body(item, eye):
    """An object, as a mesh or as a lamp; lamps block no light."""
    if shapes.is_lamp(item):
        radius = item["shape"]["radius_m"]
        ball = lamp("POINT", energy=4 * math.pi**2 * radius**2 * item["emitted_radiance"], shadow_soft_size=radius)
        ball.location, ball.visible_camera = item["shape"]["center_m"], True
    for solid in shapes.core(item, eye) if shapes.is_lamp(item) else [item]:
        corners, faces = shapes.polygons(solid["shape"])
        mesh = bpy.data.meshes.new("mesh")
        mesh.from_pydata(corners.tolist(), [], faces)
        mesh.materials.append(material(solid))
        add(mesh)


def light(item):
    """A light without extent."""
    match item:
        case {"kind": "point", "position_m": position, "intensity": intensity}:
            lamp("POINT", energy=4 * math.pi * intensity).location = position
        case {"kind": "sun", "direction": direction, "irradiance": irradiance}:
            aim(lamp("SUN", energy=irradiance, angle=0.0), (0, 0, 0), direction)
        case {"kind": "spot", "position_m": position, "target_m": target, "intensity": intensity}:
            if item["dark_from_degrees"] > 90:
                raise Unsupported("spots wider than a half space are cut off")
            if item.get("falloff") not in (None, "smooth_in_cosine"):
                raise Unsupported("spots fall off by a smooth step in the cosine")
            even, dark = (math.radians(item[angle]) for angle in ("even_to_degrees", "dark_from_degrees"))
            blend = (math.cos(even) - math.cos(dark)) / (1 - math.cos(dark))
            spot = lamp("SPOT", energy=4 * math.pi * intensity, spot_size=2 * dark, spot_blend=blend)
            aim(spot, position, np.subtract(target, position))
        case _:
            raise protocol.unknown("light", item)


def camera(item):
    """The camera."""
    data = bpy.data.cameras.new("camera")
    distance, projection = math.dist(item["origin_m"], item["target_m"]), item["projection"]
    data.clip_start, data.clip_end = 1e-3 * distance, 1e6 * distance
    match projection:
        case {"kind": "orthographic", "width_m": width}:
            data.type, data.ortho_scale = "ORTHO", width
        case {"kind": "pinhole" | "thin_lens", "field_of_view_degrees": angle}:
            data.sensor_width = 36.0
            data.lens = 18.0 / math.tan(math.radians(angle) / 2)
        case _:
            raise protocol.unknown("projection", projection)
    if "lens_radius_m" in projection:
        data.dof.use_dof, data.dof.focus_distance = True, projection["focus_distance_m"]
        data.dof.aperture_fstop = data.lens / 1000 / (2 * projection["lens_radius_m"])
    bpy.context.scene.camera = add(data)
    aim(bpy.context.scene.camera, item["origin_m"], np.subtract(item["target_m"], item["origin_m"]), item["up"])


def sky_map(tree, item):
    """The colour of a map. Its rows are stored from below; +z is the zenith, and columns begin at -x and go on toward +y."""
    interpolation = {"none": "Closest", "linear": "Linear"}.get(item["interpolation"])
    if not interpolation:
        raise Unsupported("environment maps have rows in the middle of their cells, and this sky has not")
    rows, columns = item["rows"], item["columns"]
    pixels = np.ones((rows, columns, 4))
    pixels[:, :, :3] = np.reshape(item["radiance"], (rows, columns, 1))[::-1, ::-1]
    image = bpy.data.images.new("sky", columns, rows, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    up, first = np.array(item["zenith"]), np.array(item["meridian"])
    turn = Matrix([-first, -np.cross(up, first), up]).to_euler()
    direction = node(tree, "Mapping", {"Vector": node(tree, "TexCoord", output="Generated"), "Rotation": turn})
    return node(tree, "TexEnvironment", {"Vector": direction}, image=image, interpolation=interpolation)


def sky(item):
    """What surrounds all."""
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world, world.use_nodes = world, True
    tree = world.node_tree
    inputs = tree.nodes["Background"].inputs
    inputs["Strength"].default_value = 1.0
    if item["kind"] == "even":
        inputs["Color"].default_value = grey(item["radiance"])
    else:
        tree.links.new(sky_map(tree, item), inputs["Color"])


def settings(job, pixels):
    """Samples, seed, film; and in the mode `measure` all off that has a bias."""
    scene = bpy.context.scene
    scene.render.engine, cycles = "CYCLES", scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", job["samples"], job["seed"]
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.use_denoising = False  # in both modes: it is not part of what Cycles computes, and changes even an even wall
    if job["mode"] == "measure":
        cycles.use_adaptive_sampling = False
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = cycles.blur_glossy = 0.0
        for light_path in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
            setattr(cycles, f"{light_path}_bounces", 1024)
    render, image = scene.render, scene.render.image_settings
    render.threads_mode, render.threads = "FIXED", job["threads"]
    render.resolution_x = render.resolution_y = pixels
    render.resolution_percentage, render.filepath, render.use_file_extension = 100, job["out"], False
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"


def render(scene, job):
    """Renders a scene and writes the picture."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for item in scene["objects"]:
        body(item, scene["camera"]["origin_m"])
    for item in scene["lights"]:
        light(item)
    if scene["sky"]:
        sky(scene["sky"])
    camera(scene["camera"])
    settings(job, scene["pixels"])
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    protocol.serve(lambda: f"Cycles of Blender {bpy.app.version_string}", render)
