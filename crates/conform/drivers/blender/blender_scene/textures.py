"""What feeds the inputs of shaders: numbers, colours and textures.

A value (see `elements`) of the kind "colour" or "number". Blender makes a number of a colour by its luminance.
"""

import numpy as np
from mathutils import Euler, Matrix

from . import images
from .elements import boolean, parameter, plugin, string, text, transform

WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "zero", "MIRROR": "mirror"}
FLIP = np.array([[1, 0, 0, 0], [0, -1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1.0]])  # v from below in Blender, from above in Etalon


def as_kind(value, kind):
    """A constant as a number or as a colour."""
    if kind == "number" and isinstance(value, tuple):
        return float(np.dot(value, images.LUMINANCE))
    return (value,) * 3 if kind == "colour" and isinstance(value, float) else value


def is_constant(value):
    """Whether it is the same everywhere."""
    return isinstance(value, (float, tuple))


def combine(kind, name, a, b, numbers):
    """A texture of two values; of constants, the constant by `numbers`."""
    if is_constant(a) and is_constant(b):
        result = numbers(np.array(as_kind(a, kind)), np.array(as_kind(b, kind)))
        return tuple(map(float, result)) if kind == "colour" else float(result)
    return plugin("texture", name, parameter("a", a), parameter("b", b))


def product(a, b, kind):
    """a × b."""
    for one, other in ((a, b), (b, a)):
        if one in (1.0, (1.0, 1.0, 1.0)):
            return as_kind(other, kind)
    return combine(kind, "multiply", a, b, lambda x, y: x * y)


def mixed(a, b, share, kind):
    """a (1 − share) + b share."""
    if is_constant(a) and is_constant(b) and a == b:
        return a
    if is_constant(share):
        share = as_kind(share, "number")
        if share in (0.0, 1.0):
            return (a, b)[int(share)]
        if is_constant(a) and is_constant(b):
            return combine(kind, "", a, b, lambda x, y: x + (y - x) * share)
    return plugin("texture", "mix", parameter("a", a), parameter("b", b), parameter("weight", share))


def inverted(value, kind):
    """1 − a; of a texture, if it is of numbers."""
    if is_constant(value):
        return tuple(1.0 - part for part in value) if isinstance(value, tuple) else 1.0 - value
    return mixed(as_kind(1.0, kind), as_kind(0.0, kind), value, kind)


class Textures:
    """Textures of one material; remembers which texture coordinates and colours of vertices they ask for."""

    def __init__(self, export, material):
        self.export, self.material = export, material
        self.layer = None  # the name of the texture coordinates; "" for those that Blender renders by default
        self.attributes = set()

    def value(self, field, kind):
        """The value of an input."""
        node = field.source()
        if node is None:
            return as_kind(field.constant(), kind)
        make = getattr(self, f"of_{node.kind}", None)
        found = make(node, kind) if make and not node.node.mute else None
        if found is None:
            value = as_kind(field.constant(), kind)
            shown = f"({', '.join(f'{part:.4g}' for part in value)})" if isinstance(value, tuple) else f"{value:.4g}"
            self.note(node, f"the node {node.node.bl_label} is not read; {field.socket.name} has its own value {shown} instead")
            return value
        return found

    def note(self, node, what):
        """Says what is left out of this material."""
        self.export.note(node.where(self.material), what)

    def of_RGB(self, node, kind):
        """A colour."""
        return as_kind(tuple(node.output.default_value)[:3], kind)

    def of_Value(self, node, kind):
        """A number."""
        return as_kind(float(node.output.default_value), kind)

    def of_TexImage(self, node, kind):
        """An image: its colour, its luminance or its alpha."""
        which = 3 if node.output.name == "Alpha" else "luminance"
        return self.bitmap(node, which if which == 3 or kind == "number" else "colour")

    def bitmap(self, node, which):
        """An image as a texture: in "colour", as "raw" numbers, or one channel."""
        image, where = node.node.image, node.where(self.material)
        if not images.check(self.export, image, where):
            return 0.0 if which != "colour" else (0.0,) * 3
        if node.node.projection != "FLAT":
            self.note(node, f"the projection {node.node.projection.lower()} is read as flat")
        of_bytes = which == "colour" and not image.is_float
        kept = which in ("colour", "raw")
        path = images.colours(self.export, image) if kept else images.channel(self.export, image, which)
        wrap = WRAPS[node.node.extension]
        return plugin(
            "texture",
            "bitmap",
            string("filename", path),
            boolean("raw", True) if which != "colour" else None,
            parameter("gamma", 1.0) if of_bytes and images.is_numbers(image) else None,
            string("wrap_mode", wrap) if wrap != "repeat" else None,
            string("filter_type", "nearest") if node.node.interpolation == "Closest" else None,
            self.placed(node["Vector"]),
        )

    def placed(self, vector):
        """How the input of a texture moves texture coordinates."""
        matrix = Matrix()
        while (node := vector.source()) and node.kind == "Mapping":
            matrix = matrix @ mapping(node)
            if any(node[name].source() for name in ("Location", "Rotation", "Scale") if name in node):
                self.note(node, "what feeds location, rotation or scale is not read")
            vector = node["Vector"]
        layer = ""
        if node and node.kind == "UVMap":
            layer = node.node.uv_map
        elif node and not (node.kind == "TexCoord" and node.output.name == "UV"):
            self.note(node, f"coordinates of {node.node.bl_label}, {node.output.name}, are not read; UV is used")
        if self.layer not in (None, layer):
            self.export.note(self.material, f"one set of texture coordinates is used, not {layer or 'the default'} as well")
        self.layer = layer if self.layer is None else self.layer
        flat = np.eye(4)
        flat[:2, :2], flat[:2, 3] = np.array(matrix)[:2, :2], np.array(matrix)[:2, 3]
        return None if np.allclose(flat, np.eye(4)) else transform("to_uv", FLIP @ flat @ FLIP)

    def of_VertexColor(self, node, kind):
        """Colours of vertices."""
        name = node.node.layer_name
        if kind == "number" or node.output.name != "Color":
            return None
        return self.painted(name)

    def of_Attribute(self, node, kind):
        """The same, by the node for all kinds of attributes."""
        if kind == "number" or node.output.name != "Color" or node.node.attribute_type != "GEOMETRY":
            return None
        return self.painted(node.node.attribute_name)

    def painted(self, name):
        """The colours of the vertices of this name."""
        self.attributes.add(name)
        return plugin("texture", "mesh_attribute", string("name", f"vertex_{attribute(name)}_color"))

    def of_SeparateColor(self, node, kind):
        """A channel of an image."""
        feed = node["Color"].source()
        channels = {"Red": 0, "Green": 1, "Blue": 2}
        if node.node.mode != "RGB":
            return None
        if feed is None:
            return as_kind(node["Color"].constant()[channels[node.output.name]], kind)
        return self.bitmap(feed, channels[node.output.name]) if feed.kind == "TexImage" else None

    def of_ValToRGB(self, node, kind):
        """A ramp of colours; curved ones by 65 points of them."""
        if node.output.name != "Color":
            return None
        ramp, position = node.node.color_ramp, self.value(node[0], "number")
        if is_constant(position):
            return as_kind(tuple(ramp.evaluate(position))[:3], kind)
        if ramp.color_mode == "RGB" and ramp.interpolation in ("LINEAR", "CONSTANT"):
            stops = [(stop.position, tuple(stop.color)) for stop in ramp.elements]
        else:
            stops = [(step / 64, tuple(ramp.evaluate(step / 64))) for step in range(65)]
        if ramp.color_mode == "RGB" and ramp.interpolation == "CONSTANT":  # each colour lasts until the next one
            stops += [(after[0], before[1]) for before, after in zip(stops, stops[1:])]
            stops = [stop for _, stop in sorted(enumerate(stops), key=lambda one: (one[1][0], -one[0]))]
        colours = [as_kind(as_kind(colour[:3], kind), "colour") for _, colour in stops]
        return plugin(
            "texture",
            "ramp",
            parameter("input", position),
            string("positions", " ".join(text(place) for place, _ in stops)),
            string("colors", ", ".join(" ".join(map(text, colour)) for colour in colours)),
        )

    def of_Mix(self, node, kind):
        """The node Mix, of colours or numbers."""
        inner = {"RGBA": "colour", "FLOAT": "number"}.get(node.node.data_type)
        if inner is None:
            return None
        blend = node.node.blend_type if inner == "colour" else "MIX"
        return self.blended(blend, node["Factor"], node["A"], node["B"], kind)

    def of_MixRGB(self, node, kind):
        """Its forerunner."""
        return self.blended(node.node.blend_type, node[0], node[1], node[2], kind)

    def blended(self, blend, factor, first, second, kind):
        """Two inputs, mixed, multiplied or added by a factor."""
        if blend not in ("MIX", "MULTIPLY", "ADD"):
            return None
        share, a, b = self.value(factor, "number"), self.value(first, kind), self.value(second, kind)
        if blend == "MULTIPLY":  # a (1 − share + share b)
            return product(a, mixed(as_kind(1.0, kind), b, share, kind), kind)
        if blend == "ADD":
            return combine(kind, "add", a, product(b, share, kind), lambda x, y: x + y)
        return mixed(a, b, share, kind)

    def of_Math(self, node, kind):
        """Products and sums."""
        if node.node.operation not in ("MULTIPLY", "ADD") or node.node.use_clamp:
            return None
        a, b = self.value(node[0], "number"), self.value(node[1], "number")
        if node.node.operation == "MULTIPLY":
            return as_kind(product(a, b, "number"), kind)
        return as_kind(combine("number", "add", a, b, lambda x, y: x + y), kind)

    def of_Invert(self, node, kind):
        """1 − a, by a factor."""
        colour, share = self.value(node["Color"], kind), self.value(node[0], "number")
        if share == 1.0:
            return inverted(colour, kind) if kind == "number" or is_constant(colour) else None
        if not is_constant(colour):
            return None
        return mixed(colour, inverted(colour, kind), share, kind)


def attribute(name):
    """The name of an attribute in a file of meshes."""
    return "painted_" + "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name).lower()


def mapping(node):
    """The matrix of a node Mapping."""
    part = {name: node[name].constant() for name in ("Location", "Rotation", "Scale") if name in node}
    turn = Euler(part["Rotation"]).to_matrix().to_4x4() @ Matrix.Diagonal((*part["Scale"], 1.0))
    place = Matrix.Translation(part["Location"]) if "Location" in part else Matrix()
    match node.node.vector_type:
        case "TEXTURE":
            return (place @ turn).inverted_safe()
        case "POINT":
            return place @ turn
    return turn
