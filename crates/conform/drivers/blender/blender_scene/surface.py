"""What a shader makes of a surface: light that arrives goes straight on in part, the rest is scattered; and it may shine."""

from dataclasses import dataclass
from typing import Any

from .elements import boolean, parameter, plugin, radiance
from .textures import inverted, is_constant, mixed, product


@dataclass
class Surface:
    """A shader's result. `scattering` is a BSDF, or None if it absorbs all; `through` is the share that goes straight on, as
    a value; `radiance` is what it emits to both sides, as a value, or None."""

    scattering: Any = None
    through: Any = 0.0
    radiance: Any = None


def black():
    """What scatters nothing."""
    return plugin("bsdf", "twosided", plugin("bsdf", "diffuse", parameter("reflectance", 0.0)))


def is_invisible(surface):
    """Whether light goes through as if there were nothing."""
    return surface.through == 1.0 and surface.radiance is None


def mix(a, b, share, note):
    """Two shaders, the second by a share (`Mix Shader`)."""
    if share in (0.0, 1.0):
        return (a, b)[int(share)]
    through = mixed(a.through, b.through, share, "number")
    shines = None
    if a.radiance is not None or b.radiance is not None:
        lights = [(0.0, 0.0, 0.0) if part.radiance is None else part.radiance for part in (a, b)]
        shines = mixed(*lights, share, "colour")
    if a.through == 1.0 or b.through == 1.0:  # one of them is a hole
        scattering = b.scattering if a.through == 1.0 else a.scattering
    elif a.scattering is None and b.scattering is None:
        scattering = None
    else:
        if (a.through, b.through) != (0.0, 0.0):
            note("a mix of shaders that let light through in part is approximate")
        parts = [black() if part.scattering is None else part.scattering for part in (a, b)]
        scattering = plugin("bsdf", "blendbsdf", parameter("weight", share), *parts)
    return Surface(scattering, through, shines)


def add(a, b, note):
    """Two shaders at once (`Add Shader`): exact where one of them scatters nothing."""
    if a.scattering is not None and b.scattering is not None:
        note("of a sum of two shaders that scatter, the first is used")
    if not (is_constant(a.through) and is_constant(b.through)):
        note("of a sum of shaders with holes by a texture, the first's holes are used")
        through = a.through
    else:
        through = min(a.through + b.through, 1.0)
    lights = [part.radiance for part in (a, b) if part.radiance is not None]
    shines = lights[0] if lights else None
    if len(lights) == 2:
        if all(map(is_constant, lights)):
            shines = tuple(x + y for x, y in zip(*lights))
        else:
            shines = plugin("texture", "add", parameter("a", lights[0]), parameter("b", lights[1]))
    return Surface(a.scattering if a.scattering is not None else b.scattering, through, shines)


def with_alpha(surface, alpha):
    """A surface that is there in part; what is not there does not shine."""
    if alpha == 1.0:
        return surface
    shines = None if surface.radiance is None else product(surface.radiance, alpha, "colour")
    return Surface(surface.scattering, inverted(alpha, "number"), shines)


def material(surface):
    """The BSDF of a surface."""
    inner = black() if surface.scattering is None else surface.scattering
    if surface.through == 0.0:
        return inner
    if surface.through == 1.0:
        return plugin("bsdf", "null")
    return plugin("bsdf", "mask", parameter("opacity", inverted(surface.through, "number")), inner)


def emitter(surface):
    """What it emits; None if nothing."""
    if surface.radiance is None or surface.radiance == (0.0, 0.0, 0.0):
        return None
    return plugin("emitter", "area", radiance(surface.radiance), boolean("twosided", True))
