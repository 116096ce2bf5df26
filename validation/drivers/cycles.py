"""Driver: Cycles, by the module `bpy` of Blender 5.

Facts that it rests on: an emission's strength is radiance; a point lamp of power P has the intensity P/4π and, with a radius
r and without soft falloff, is a true sphere of the radiance P/4π²r²; a spot has P/4π too, whatever its cone; a sun's strength
is irradiance. There are no exact spheres but lamps: a black sphere that shines becomes one, all others become fine meshes of
the same area.
"""

import math

import protocol
from protocol import Unsupported

import bpy
import numpy as np
from mathutils import Matrix, Vector

BLACK = {"kind": "diffuse", "reflectance": 0.0}
CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def node(tree, kind, options=None, **inputs):
    """A new shader node with these options, then these inputs (spaces in their names are underscores here)."""
    new = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in (options or {}).items():
        setattr(new, name, value)
    for name, value in inputs.items():
        new.inputs[name.replace("_", " ")].default_value = value
    return new


def grey(value):
    """A colour."""
    return (value, value, value, 1.0)


def surface(tree, material):
    """How a material scatters light, as a shader."""
    match material:
        case {"kind": "diffuse", "reflectance": rho}:
            return node(tree, "BsdfDiffuse", Color=grey(rho), Roughness=0.0)
        case {"kind": "mirror", "reflectance": rho}:
            return node(tree, "BsdfAnisotropic", Color=grey(rho), Roughness=0.0)
        case {"kind": "conductor", "n": n, "k": k}:
            return node(tree, "BsdfMetallic", {"fresnel_type": "PHYSICAL_CONDUCTOR"}, IOR=(n, n, n), Extinction=(k, k, k), Roughness=0.0)
        case {"kind": "glass", "n": n}:
            return node(tree, "BsdfGlass", Color=grey(1.0), IOR=n, Roughness=0.0)
        case {"kind": "nothing"}:
            return node(tree, "BsdfTransparent", Color=grey(1.0))
    raise Unsupported(f"the material {material['kind']} is not known")


def emission(tree, radiance):
    """A shader that emits from the outer side only."""
    mix, sides = node(tree, "MixShader"), node(tree, "NewGeometry")
    tree.links.new(sides.outputs["Backfacing"], mix.inputs[0])
    for slot, strength in ((1, radiance), (2, 0.0)):
        tree.links.new(node(tree, "Emission", Strength=strength).outputs[0], mix.inputs[slot])
    return mix


def material(item):
    """The material of an object: what it scatters, what it emits, and what is inside."""
    new = bpy.data.materials.new("material")
    new.use_nodes = True
    tree = new.node_tree
    tree.nodes.clear()
    end = node(tree, "OutputMaterial")
    radiance, medium = item["emitted_radiance"], item["interior"]
    shader = surface(tree, item["material"])
    if radiance:
        scattered, shader = shader, node(tree, "AddShader")
        tree.links.new(scattered.outputs[0], shader.inputs[0])
        tree.links.new(emission(tree, radiance).outputs[0], shader.inputs[1])
    if item["material"]["kind"] != "nothing" or not medium:  # the border of a medium has none, a void body a clear one
        tree.links.new(shader.outputs[0], end.inputs["Surface"])
    if medium:
        absorption, scattering = medium["absorption_per_m"], medium["scattering_per_m"]
        inside = node(tree, "VolumeCoefficients", Absorption_Coefficients=[absorption] * 3, Scatter_Coefficients=[scattering] * 3)
        tree.links.new(inside.outputs[0], end.inputs["Volume"])
    return new


def polygons(shape):
    """Corners and faces of a shape, which turn to the left from outside."""
    match shape:
        case {"kind": "quad", "center_m": center, "half_u_m": u, "half_v_m": v}:
            return np.add(center, np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ [u, v]), [(0, 1, 2, 3)]
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            return np.add(center, np.array(CORNERS) @ axes), FACES
        case {"kind": "mesh", "positions_m": positions, "triangles": triangles}:
            return np.array(positions), triangles
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, radius=1.0)
            ball = bpy.context.object
            points = np.array([vertex.co for vertex in ball.data.vertices], float)
            faces = [tuple(face.vertices) for face in ball.data.polygons]
            bpy.data.objects.remove(ball)
            a, b, c = points[np.array(faces)].transpose(1, 0, 2)
            area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
            points *= radius * math.sqrt(4 * math.pi / area)
            return points + center, [face[::-1] for face in faces] if inward else faces
    raise Unsupported(f"the shape {shape['kind']} is not known")


def add(data):
    """Puts a lamp, a mesh or a camera into the scene."""
    thing = bpy.data.objects.new("object", data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def aim(thing, origin, forward, up=None):
    """Turns a thing that looks along its −z axis; without `up` its turn about that axis is of no matter."""
    z = -Vector(forward).normalized()
    x = (Vector(up) if up else z.orthogonal()).cross(z).normalized()
    thing.matrix_world = Matrix.Translation(origin) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()


def lamp(kind, **settings):
    """A lamp of no extent, or of what `settings` say."""
    data = bpy.data.lights.new("lamp", kind)
    if kind != "SUN":
        data.shadow_soft_size, data.use_soft_falloff = 0.0, False
    for name, value in settings.items():
        setattr(data, name, value)
    return add(data)


def sphere_lamp(shape, radiance, eye):
    """A black sphere that shines, as a lamp. Lamps block no light, so that a black core just beneath its surface does, unless
    the sphere looks so small that it blocks next to nothing (and single precision could not tell the two surfaces apart)."""
    center, radius = shape["center_m"], shape["radius_m"]
    ball = lamp("POINT", energy=4 * math.pi**2 * radius**2 * radiance, shadow_soft_size=radius)
    ball.location, ball.visible_camera = center, True
    if radius > 0.01 * math.dist(center, eye):
        body({"shape": {**shape, "radius_m": 0.999 * radius}, "material": BLACK, "emitted_radiance": 0, "interior": None}, eye)


def body(item, eye):
    """An object, as a mesh or as a lamp."""
    shape, radiance = item["shape"], item["emitted_radiance"]
    if shape["kind"] == "sphere" and not shape["inward"] and item["material"] == BLACK and radiance:
        sphere_lamp(shape, radiance, eye)
        return
    corners, faces = polygons(shape)
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(corners.tolist(), [], faces)
    mesh.materials.append(material(item))
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
            even, dark = (math.radians(item[angle]) for angle in ("even_to_degrees", "dark_from_degrees"))
            blend = (math.cos(even) - math.cos(dark)) / (1 - math.cos(dark))  # smooth in the cosine between the angles
            spot = lamp("SPOT", energy=4 * math.pi * intensity, spot_size=2 * dark, spot_blend=blend)
            aim(spot, position, np.subtract(target, position))
        case _:
            raise Unsupported(f"the light {item['kind']} is not known")


def camera(item):
    """The camera."""
    data = bpy.data.cameras.new("camera")
    forward = Vector(item["target_m"]) - Vector(item["origin_m"])
    data.clip_start, data.clip_end = 1e-3 * forward.length, 1e6 * forward.length
    projection = item["projection"]
    match projection["kind"]:
        case "orthographic":
            data.type, data.ortho_scale = "ORTHO", projection["width_m"]
        case "pinhole" | "thin_lens":
            data.sensor_width = 36.0
            data.lens = 18.0 / math.tan(math.radians(projection["field_of_view_degrees"]) / 2)
        case kind:
            raise Unsupported(f"the projection {kind} is not known")
    if "lens_radius_m" in projection:
        data.dof.use_dof, data.dof.focus_distance = True, projection["focus_distance_m"]
        data.dof.aperture_fstop = data.lens / 1000 / (2 * projection["lens_radius_m"])
    bpy.context.scene.camera = add(data)
    aim(bpy.context.scene.camera, item["origin_m"], forward, item["up"])


def sky_map(tree, item):
    """The colour of a map. Its rows are stored from below; +z is the zenith, and columns begin at -x and go on toward +y."""
    if item["interpolation"] not in ("none", "linear"):
        raise Unsupported("environment maps have rows in the middle of their cells, and this sky has not")
    rows, columns = item["rows"], item["columns"]
    pixels = np.ones((rows, columns, 4))
    pixels[:, :, :3] = np.reshape(item["radiance"], (rows, columns, 1))[::-1, ::-1]
    image = bpy.data.images.new("sky", columns, rows, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    interpolation = {"none": "Closest", "linear": "Linear"}[item["interpolation"]]
    texture = node(tree, "TexEnvironment", {"image": image, "interpolation": interpolation})
    up, first = Vector(item["zenith"]), Vector(item["meridian"])
    turn = node(tree, "Mapping", Rotation=Matrix((-first, -up.cross(first), up)).to_euler())
    tree.links.new(node(tree, "TexCoord").outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs[0], texture.inputs["Vector"])
    return texture.outputs["Color"]


def sky(item):
    """What surrounds all."""
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world, world.use_nodes = world, True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = grey(1.0)
    background.inputs["Strength"].default_value = item.get("radiance", 0.0) if item and item["kind"] == "even" else float(bool(item))
    if item and item["kind"] == "map":
        world.node_tree.links.new(sky_map(world.node_tree, item), background.inputs["Color"])


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
    sky(scene["sky"])
    camera(scene["camera"])
    settings(job, scene["pixels"])
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    protocol.serve(lambda: f"Cycles of Blender {bpy.app.version_string}", render)
