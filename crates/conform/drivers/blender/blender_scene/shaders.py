"""Shader nodes as BSDFs.

Cycles' facets are GGX, α = roughness², and hide each other by their height (Heitz 2014): `masking` `correlated`. Its
"Multiscatter GGX" also gives back the light that hits several facets, which no plugin here does.
"""

from . import principled, surface
from .elements import boolean, parameter, plugin, string, vector
from .inputs import output, uses_nodes
from .surface import Surface
from .textures import Textures, as_kind, is_constant, product

SMOOTH = 0.01  # the roughness below which Etalon's surface is a perfect mirror or pane; α is 0.0001 there


def facets(kind, smooth, rough, *parts):
    """A BSDF of GGX facets of this roughness, or the smooth one of the same name."""
    if is_constant(rough) and rough < SMOOTH:
        return plugin("bsdf", smooth, *parts)
    alpha = parameter("alpha", product(rough, rough, "number"))
    return plugin("bsdf", kind, string("distribution", "ggx"), string("masking", "correlated"), alpha, *parts)


def both_sides(*bsdf):
    """An opaque BSDF, for both sides of the surface."""
    return plugin("bsdf", "twosided", plugin("bsdf", *bsdf))


def glass(rough, ior, reflected, transmitted):
    """Clear or frosted glass of constant index; of the index of the air, a sheet that only colours what goes through."""
    if abs(ior - 1.0) < 1e-4:
        rough, sheet, ior = 0.0, "thindielectric", 1.0
    else:
        sheet = "dielectric"
    parts = [parameter("int_ior", ior), parameter("ext_ior", 1.0)]
    for name, colour in (("specular_reflectance", reflected), ("specular_transmittance", transmitted)):
        if colour != (1.0, 1.0, 1.0):
            parts.append(parameter(name, colour))
    return facets("roughdielectric", sheet, rough, *parts)


class Shaders(Textures):
    """The shaders of one material."""

    def surface(self, field):
        """What an input of the kind shader is fed."""
        node = field.source()
        if node is None:
            return Surface()
        make = getattr(self, f"shader_{node.kind}", None)
        if make is None or node.node.mute:
            colour = (0.8, 0.8, 0.8)
            if "Color" in node:
                colour = self.value(node["Color"], "colour")
            self.note(node, f"the shader {node.node.bl_label} is not read; a diffuse one of its colour stands in")
            return Surface(both_sides("diffuse", parameter("reflectance", colour)))
        return make(node)

    def number(self, node, name):
        """A value of the kind number."""
        return self.value(node[name], "number")

    def colour(self, node, name="Color"):
        """A value of the kind colour; no surface reflects more than it receives."""
        value = self.value(node[name], "colour")
        return tuple(min(max(part, 0.0), 1.0) for part in value) if is_constant(value) else value

    def constant(self, node, name, kind="number"):
        """A value that must not vary over the surface."""
        value = self.value(node[name], kind)
        if is_constant(value):
            return value
        self.note(node, f"{name} cannot vary; its own value is used")
        return as_kind(node[name].constant(), kind)

    def shader_BsdfPrincipled(self, node):
        """Blender's most used one."""
        return principled.surface(self, node)

    def shader_BsdfDiffuse(self, node):
        """Lambert, or Oren and Nayar if it is rough."""
        colour, rough = parameter("reflectance", self.colour(node)), self.number(node, "Roughness")
        if rough == 0.0:
            bsdf = both_sides("diffuse", colour)
        else:
            bsdf = both_sides("roughdiffuse", colour, parameter("alpha", rough), string("model", "eon"))
        return Surface(self.tilted(node, bsdf))

    def shader_BsdfAnisotropic(self, node):
        """Glossy: a mirror without Fresnel's equations."""
        if node["Anisotropy"].source() or node["Anisotropy"].constant():
            self.note(node, "anisotropy is left out")
        colour = parameter("specular_reflectance", self.colour(node))
        bsdf = facets("roughconductor", "conductor", self.number(node, "Roughness"), string("material", "none"), colour)
        return Surface(self.tilted(node, plugin("bsdf", "twosided", bsdf)))

    shader_BsdfGlossy = shader_BsdfAnisotropic

    def shader_BsdfMetallic(self, node):
        """Metal by n and k, or by its colour."""
        rough = self.number(node, "Roughness")
        if node.node.fresnel_type == "PHYSICAL_CONDUCTOR":
            names = (("eta", "IOR"), ("k", "Extinction"))
            parts = [parameter(name, self.constant(node, theirs, "colour")) for name, theirs in names]
            bsdf = facets("roughconductor", "conductor", rough, *parts)
        else:
            bsdf = principled.metal(self.colour(node, "Base Color"), rough)
            if node["Edge Tint"].source() or node["Edge Tint"].constant() != (1.0, 1.0, 1.0):
                self.note(node, "the tint of the edge is left out")
        return Surface(self.tilted(node, plugin("bsdf", "twosided", bsdf)))

    def shader_BsdfGlass(self, node):
        """Glass; its colour multiplies what is reflected and what is transmitted."""
        colour = self.colour(node)
        bsdf = glass(self.number(node, "Roughness"), self.constant(node, "IOR"), colour, colour)
        return Surface(self.tilted(node, bsdf))

    def shader_BsdfRefraction(self, node):
        """Glass that reflects nothing."""
        self.note(node, "Refraction loses what Fresnel's equations reflect")
        bsdf = glass(self.number(node, "Roughness"), self.constant(node, "IOR"), (0.0,) * 3, self.colour(node))
        return Surface(self.tilted(node, bsdf))

    def shader_BsdfTranslucent(self, node):
        """A matte sheet that light comes through."""
        return Surface(self.tilted(node, plugin("bsdf", "difftrans", parameter("transmittance", self.colour(node)))))

    def shader_BsdfTransparent(self, node):
        """A hole, or a coloured filter: a pane that reflects nothing as its index is that of the air."""
        colour = self.colour(node)
        if colour == (1.0, 1.0, 1.0):
            return Surface(None, 1.0)
        if is_constant(colour) and len(set(colour)) == 1:
            return Surface(None, colour[0])
        parts = [parameter("int_ior", 1.0), parameter("ext_ior", 1.0), parameter("specular_transmittance", colour)]
        return Surface(plugin("bsdf", "thindielectric", *parts))

    def shader_Holdout(self, node):
        """A black hole in the picture."""
        self.note(node, "Holdout is black, and not a hole in alpha")
        return Surface()

    def shader_Emission(self, node):
        """A surface that shines; its strength is radiance."""
        strength = self.number(node, "Strength")
        return Surface(None, 0.0, product(self.value(node["Color"], "colour"), strength, "colour"))

    shader_Background = shader_Emission  # on a surface it does the same

    def shader_MixShader(self, node):
        """Two shaders by a share."""
        share = self.value(node[0], "number")
        return surface.mix(self.surface(node[1]), self.surface(node[2]), share, lambda what: self.note(node, what))

    def shader_AddShader(self, node):
        """Two shaders at once."""
        return surface.add(self.surface(node[0]), self.surface(node[1]), lambda what: self.note(node, what))

    def tilted(self, node, bsdf):
        """A BSDF with the normals of a map or of heights, if a node asks for them."""
        source = node["Normal"].source() if "Normal" in node else None
        if source is None:
            return bsdf
        if source.kind == "NormalMap":
            return self.normal_map(source, bsdf)
        if source.kind == "Bump":
            return self.bump(source, bsdf)
        self.note(source, "these normals are not read; the surface keeps its own")
        return bsdf

    def normal_map(self, node, bsdf):
        """Normals of a picture in the frame of the texture coordinates. Those that are turned from the viewer, which Cycles bends
        toward the surface, stay: what they make black is nearer to that than what mirrored ones make bright."""
        picture = node["Color"].source()
        if node.node.space != "TANGENT" or picture is None or picture.kind != "TexImage":
            self.note(node, "only an image in tangent space is read as a normal map; the surface keeps its normals")
            return bsdf
        normals, strength = self.bitmap(picture, "raw"), self.constant(node, "Strength")
        if is_constant(normals):
            return bsdf
        if strength != 1.0:
            normals = strengthened(normals, max(strength, 0.0))
        keep = boolean("flip_invalid_normals", False)
        return plugin("bsdf", "normalmap", parameter("normalmap", normals), keep, bsdf)

    def bump(self, node, bsdf):
        """Normals of heights."""
        heights = self.value(node["Height"], "number")
        if is_constant(heights):
            return bsdf
        if node["Normal"].source():
            self.note(node, "normals below a bump are left out")
        scale = self.constant(node, "Strength") * self.constant(node, "Distance") * (-1 if node.node.invert else 1)
        keep = boolean("flip_invalid_normals", False)
        return plugin("bsdf", "bumpmap", parameter("heights", heights), parameter("scale", scale), keep, bsdf)


def strengthened(normals, strength):
    """Normals of the colours c = (1 + n)/2 as those of (s x, s y, z), z moved toward 1 if s < 1; no colour may exceed 1, so what
    is above 1 makes z smaller instead."""
    if strength <= 1.0:
        even = plugin("texture", "rawconstant", vector("value", (0.5, 0.5, 1.0)))
        return plugin("texture", "mix", parameter("a", even), parameter("b", normals), parameter("weight", strength))
    factor = plugin("texture", "rawconstant", vector("value", (1.0, 1.0, 1.0 / strength)))
    rest = plugin("texture", "rawconstant", vector("value", (0.0, 0.0, 0.5 - 0.5 / strength)))
    turned = plugin("texture", "multiply", parameter("a", normals), parameter("b", factor))
    return plugin("texture", "add", parameter("a", turned), parameter("b", rest))


def material(export, data):
    """The surface of a material of Blender (or of none) and the textures that it uses."""
    return export.once(("material", data.name_full if data else None), lambda: make_material(export, data))


def make_material(export, data):
    """Reads it."""
    shaders = Shaders(export, f"material {data.name}" if data else "no material")
    if data is None or not uses_nodes(data):
        colour = tuple(data.diffuse_color)[:3] if data else (0.8, 0.8, 0.8)
        return Surface(both_sides("diffuse", parameter("reflectance", colour))), shaders
    end = output(data, "Surface")
    made = shaders.surface(end) if end else Surface()
    for part in ("Volume", "Displacement"):
        if end and output(data, part).source():
            export.note(shaders.material, f"{part.lower()} is left out")
    return made, shaders
