"""Blender's Principled BSDF as `principled`, `dielectric` or a mix of both.

| Blender (version 2 of the model) | Etalon |
|---|---|
| Base Color, Metallic, Roughness | `base_color`, `metallic`, `roughness` (both have α = roughness²) |
| IOR n, Specular IOR Level s | `eta` of the reflectance 2 s ((n − 1)/(n + 1))² at normal incidence |
| Transmission | a `dielectric` or `roughdielectric` by this share; each interface transmits √colour |
| Coat | 4 × `clearcoat`, `clearcoat_gloss` (Disney's coat reflects a quarter of its interface; α = 0.1 − 0.099 gloss) |
| Sheen | `sheen`, which is Disney's |
| Emission, Alpha | `area`, `mask` |

The diffuse part is Lambert's below the interface, as Blender's.
"""

import math

from .elements import parameter, plugin, string
from .surface import Surface, with_alpha
from .textures import is_constant, product

LEFT_OUT = ("Subsurface Weight", "Anisotropic", "Thin Film Thickness", "Diffuse Roughness")


def metal(colour, rough):
    """A metal of Schlick's reflectance."""
    parts = [parameter("base_color", colour), parameter("metallic", 1.0), parameter("roughness", rough)]
    return plugin("bsdf", "principled", *parts)


def eta(ior, level):
    """The index of refraction of an interface whose reflectance is 2 s ((n − 1)/(n + 1))²."""
    root = min(math.sqrt(2.0 * max(level, 0.0)) * abs(ior - 1.0) / (ior + 1.0), 0.99)
    return (1.0 + root) / (1.0 - root)


def opaque(shaders, node, colour, rough):
    """The part that is no glass."""
    ior = eta(shaders.constant(node, "IOR"), shaders.constant(node, "Specular IOR Level"))
    parts = [parameter("base_color", colour), parameter("roughness", rough), parameter("eta", ior)]
    parts.append(string("diffuse_model", "lambert"))
    metallic, coat = shaders.number(node, "Metallic"), shaders.number(node, "Coat Weight")
    if metallic != 0.0:
        parts.append(parameter("metallic", metallic))
    if coat != 0.0:
        alpha = shaders.constant(node, "Coat Roughness") ** 2
        gloss = min(max((0.1 - alpha) / 0.099, 0.0), 1.0)
        parts += [parameter("clearcoat", product(coat, 4.0, "number")), parameter("clearcoat_gloss", gloss)]
        if shaders.constant(node, "Coat IOR") != 1.5 or shaders.constant(node, "Coat Tint", "colour") != (1.0, 1.0, 1.0):
            shaders.note(node, "the coat has the index 1.5 and no tint")
    sheen = shaders.number(node, "Sheen Weight")
    if sheen != 0.0:
        shaders.note(node, "sheen is Disney's, which is another one")
        parts.append(parameter("sheen", sheen))
    return plugin("bsdf", "twosided", plugin("bsdf", "principled", *parts))


def clear(shaders, node, colour, rough):
    """The part that is glass."""
    from .shaders import glass

    if is_constant(colour):
        root = tuple(math.sqrt(part) for part in colour)
    else:
        root = colour
        shaders.note(node, "a texture of what is transmitted colours it once at each interface, and not by its root")
    return glass(rough, shaders.constant(node, "IOR"), (1.0, 1.0, 1.0), root)


def surface(shaders, node):
    """The whole."""
    for name in LEFT_OUT:
        if name in node and (node[name].source() or node[name].constant()):
            shaders.note(node, f"{name} is left out")
    if node["Specular Tint"].source() or node["Specular Tint"].constant() != (1.0, 1.0, 1.0):
        shaders.note(node, "Specular Tint is left out")

    def look():
        return shaders.colour(node, "Base Color"), shaders.number(node, "Roughness")

    share = shaders.number(node, "Transmission Weight")
    metallic = shaders.number(node, "Metallic")
    if is_constant(share) and is_constant(metallic):
        share *= 1.0 - metallic
    elif share != 0.0 and metallic != 0.0:
        shaders.note(node, "what transmits is no metal where both vary")
    if share == 0.0:
        scattering = opaque(shaders, node, *look())
    elif share == 1.0:
        scattering = clear(shaders, node, *look())
    else:
        parts = opaque(shaders, node, *look()), clear(shaders, node, *look())
        scattering = plugin("bsdf", "blendbsdf", parameter("weight", share), *parts)
    radiance = None
    strength = shaders.number(node, "Emission Strength")
    if strength != 0.0:
        radiance = product(shaders.value(node["Emission Color"], "colour"), strength, "colour")
    whole = Surface(shaders.tilted(node, scattering), 0.0, radiance)
    return with_alpha(whole, shaders.number(node, "Alpha"))
