"""Small scenes in Blender."""

import math

import bpy
import numpy as np


def fresh(sky=(0.0, 0.0, 0.0)):
    """An empty scene with a camera that looks down on the origin, and an even sky."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    if bpy.app.version < (5, 0):
        scene.world.use_nodes = True
    background().inputs["Color"].default_value = (*sky, 1.0)
    scene.camera = place(bpy.data.cameras.new("camera"), (0.0, -6.0, 4.0), (math.radians(57), 0.0, 0.0))


def background():
    """The node that makes the sky."""
    return bpy.context.scene.world.node_tree.nodes["Background"]


def place(data, location, rotation=(0.0, 0.0, 0.0)):
    """A new object of some data."""
    new = bpy.data.objects.new(data.name, data)
    new.location, new.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(new)
    return new


def lamp(kind, location=(0.5, 0.0, 2.0), rotation=(0.4, 0.3, 0.0), **settings):
    """A lamp."""
    data = bpy.data.lights.new(kind.lower(), kind)
    for name, value in settings.items():
        setattr(data, name, value)
    return place(data, location, rotation)


def sun():
    """Parallel light."""
    lamp("SUN", energy=3.0, angle=0.0)


def material(build, name="material"):
    """A material whose surface is the output that `build` returns of the tree of nodes."""
    new = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        new.use_nodes = True
    new.node_tree.nodes.clear()
    end = new.node_tree.nodes.new("ShaderNodeOutputMaterial")
    new.node_tree.links.new(build(new.node_tree), end.inputs["Surface"])
    return new


def shader(tree, kind, **inputs):
    """The output of a new node; inputs are values, colours, or outputs of other nodes."""
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        socket = node.inputs[name.replace("_", " ")]
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = (*value, 1.0) if isinstance(value, tuple) else value
    return node.outputs[0]


def plain(kind, **inputs):
    """A material of one shader."""
    return material(lambda tree: shader(tree, kind, **inputs))


def sheet(width, depth, surface, z=0.0):
    """A rectangle with texture coordinates."""
    mesh = bpy.data.meshes.new("sheet")
    x, y = width / 2, depth / 2
    mesh.from_pydata([(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
    mesh.materials.append(surface)
    return place(mesh, (0.0, 0.0, 0.0))


def floor():
    """A matte floor that is larger than the picture."""
    return sheet(10.0, 10.0, plain("BsdfDiffuse", Color=(0.6, 0.5, 0.3)))


def ball(surface):
    """A smooth ball on the floor."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=1.0, location=(0.0, 0.0, 1.0))
    new = bpy.context.object
    new.data.shade_smooth()
    new.data.materials.append(surface)
    return new


def picture(name, width=64, height=32, is_float=True):
    """An image without any symmetry."""
    image = bpy.data.images.new(name, width, height, float_buffer=is_float)
    row, column = np.mgrid[0:height, 0:width]
    pixels = np.ones((height, width, 4), dtype=np.float32)
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = 0.1 + 0.8 * column / width, 0.1 + 0.8 * row / height, 0.3
    pixels[: height // 4, : width // 4, :3] = 0.9
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


def texture(tree, image, interpolation="Linear", **mapping):
    """A node of an image, by texture coordinates that are mapped."""
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, interpolation
    if mapping:
        uv = tree.nodes.new("ShaderNodeTexCoord").outputs["UV"]
        tree.links.new(shader(tree, "Mapping", Vector=uv), node.inputs["Vector"])
        for name, value in mapping.items():
            node.inputs["Vector"].links[0].from_node.inputs[name].default_value = value
    return node
