"""What surrounds all: `constant`, or `envmap` of an environment texture.

Blender's map of longitude and latitude has its middle column at +x, and columns to the left of it toward +y; Etalon's has its
middle at +z and columns to the left toward +x, +y being the zenith: axes are exchanged in a ring.
"""

import numpy as np

from . import images
from .elements import parameter, plugin, string, transform
from .inputs import output
from .textures import Textures, is_constant, mapping, product

RING = np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])


class World(Textures):
    """The nodes of a world."""

    def background(self, field):
        """The node Background, or None."""
        node = field.source()
        if node is None:
            return None
        if node.kind != "Background":
            self.note(node, f"the node {node.node.bl_label} is not read; the world is black")
            return None
        return node

    def turn(self, node):
        """From the map's directions to the world's."""
        matrix, vector = np.eye(3), node["Vector"]
        while (source := vector.source()) and source.kind == "Mapping":
            matrix = matrix @ np.array(mapping(source))[:3, :3]
            vector = source["Vector"]
        if source and not (source.kind == "TexCoord" and source.output.name == "Generated"):
            self.note(source, "directions are those of the output Generated")
        turn = np.eye(4)
        turn[:3, :3] = np.linalg.inv(matrix)
        if not np.allclose(matrix @ matrix.T, np.eye(3) * (matrix @ matrix.T)[0, 0], atol=1e-4):
            self.note(node, "the map is stretched, which is left out")
            return RING
        turn[:3, :3] /= np.cbrt(abs(np.linalg.det(turn[:3, :3])))
        return turn @ RING

    def map(self, node, strength):
        """An environment texture."""
        image = node.node.image
        if not images.check(self.export, image, node.where(self.material)):
            return None
        if node.node.projection != "EQUIRECTANGULAR":
            self.note(node, "a mirror ball is read as a map of longitude and latitude")
        return plugin(
            "emitter",
            "envmap",
            string("filename", images.colours(self.export, image)),
            parameter("gamma", 1.0) if images.is_numbers(image) and not image.is_float else None,
            parameter("scale", strength),
            transform("to_world", self.turn(node)),
        )


def element(export):
    """The emitter of the scene's world; None if it is black."""
    data = export.scene.world
    if data is None:
        return None
    world = World(export, f"world {data.name}")
    end = output(data, "Surface")
    node = world.background(end) if end else None
    if node is None:
        return None
    strength = world.value(node["Strength"], "number")
    if not is_constant(strength):
        world.note(node, "its strength cannot vary and is 1")
        strength = 1.0
    source = node["Color"].source()
    if source and source.kind == "TexEnvironment":
        return world.map(source, strength) if strength else None
    colour = world.value(node["Color"], "colour")
    if not is_constant(colour):
        world.note(node, "of textures only an environment texture is read; the world is grey")
        colour = (0.5, 0.5, 0.5)
    radiance = product(colour, strength, "colour")
    return plugin("emitter", "constant", parameter("radiance", radiance)) if any(radiance) else None
