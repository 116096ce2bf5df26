"""Lamps, from Blender's watts to radiance, intensity and irradiance.

A lamp of the power P (W) gives, in each of the three channels, what Cycles' has (as questions with known answers show):

| lamp | |
|---|---|
| point, spot | the intensity P/(4π²) · π = P/4π, whatever the cone of a spot; of radius r, a sphere of the radiance P/(4π² r²) |
| area of A m² | the radiance P/(π A) to one side |
| sun | its strength is irradiance; of an angle α, a disk far away of the radiance E/(π sin²(α/2)) |

Without `normalize`, P is that of 1 m² (or, of a sun, E that of π sr): the division by the size falls away. Lamps
cast no shadows, so their shapes are of the material `null`.
"""

import math

from mathutils import Matrix

from .elements import parameter, plugin, string, transform
from .inputs import Node

FAR = 1000.0  # how many sizes of the scene a sun of some extent is away


def strength(export, light, name):
    """Energy times colour, with what the lamp's nodes add."""
    factor = light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    colour = [factor * part for part in light.color]
    if getattr(light, "use_temperature", False):
        colour = [part * warmth for part, warmth in zip(colour, light.temperature_color)]
    if light.use_nodes and light.node_tree:
        end = next((node for node in light.node_tree.nodes if node.bl_idname == "ShaderNodeOutputLight" and node.is_active_output), None)
        node = Node(end, None)["Surface"].source() if end else None
        if node is None or node.kind != "Emission" or node["Color"].source() or node["Strength"].source():
            export.note(f"light {name}", "of its nodes only an Emission of constant colour and strength is read")
        else:
            colour = [a * b * node["Strength"].constant() for a, b in zip(colour, node["Color"].constant())]
    return colour


def values(colour, divisor):
    """A colour over a number."""
    return tuple(part / divisor for part in colour)


def shape(kind, matrix, radiance, *parts):
    """A shape that shines and stands in nobody's way."""
    return plugin(
        "shape",
        kind,
        *parts,
        transform("to_world", matrix),
        plugin("bsdf", "null"),
        plugin("emitter", "area", parameter("radiance", radiance)),
    )


def point(export, light, matrix, colour):
    """A point, or a sphere."""
    radius = light.shadow_soft_size
    if radius == 0.0:
        return plugin("emitter", "point", transform("to_world", Matrix.Translation(matrix.translation)), parameter("intensity", values(colour, 4 * math.pi)))
    area = 4 * math.pi * radius**2 if light.normalize else 4.0
    place = Matrix.Translation(matrix.translation) @ Matrix.Scale(radius, 4)
    return shape("sphere", place, values(colour, math.pi * area))


def spot(export, light, matrix, colour):
    """A cone of light, which looks along −z in Blender and along +z here."""
    if light.shadow_soft_size > 0.0:
        export.note(f"light {light.name}", "a spot is a point here: its shadows are sharp")
    if light.use_square:
        export.note(f"light {light.name}", "a spot is round here")
    half, blend = light.spot_size / 2, light.spot_blend
    even = math.acos(math.cos(half) + blend * (1.0 - math.cos(half)))
    return plugin(
        "emitter",
        "spot",
        transform("to_world", turned(matrix)),
        parameter("intensity", values(colour, 4 * math.pi)),
        parameter("cutoff_angle", math.degrees(half)),
        parameter("beam_width", math.degrees(even)),
        string("falloff", "smooth_in_cosine"),
    )


def turned(matrix):
    """Place and direction without sizes; along +z is what Blender has along −z."""
    place, turn, _ = matrix.decompose()
    return Matrix.LocRotScale(place, turn, None) @ Matrix.Diagonal((-1.0, 1.0, -1.0, 1.0))


def area(export, light, matrix, colour):
    """A rectangle or an ellipse."""
    if light.spread < math.pi - 1e-3:
        export.note(f"light {light.name}", "its spread is left out: it shines evenly to all directions of a half space")
    size = light.size, light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    round_one = light.shape in ("DISK", "ELLIPSE")
    place = matrix @ Matrix.Diagonal((-size[0] / 2, size[1] / 2, -1.0, 1.0))
    across = [place.col[axis].to_3d() for axis in (0, 1)]
    extent = (math.pi if round_one else 4.0) * across[0].cross(across[1]).length
    if extent == 0.0:
        export.note(f"light {light.name}", "it has no extent and is left out")
        return None
    radiance = values(colour, math.pi * (extent if light.normalize else 1.0))
    return shape("disk" if round_one else "rectangle", place, radiance)


def sun(export, light, matrix, colour, centre, size):
    """Parallel light, or a disk far away."""
    if light.angle == 0.0:
        return plugin("emitter", "directional", transform("to_world", turned(matrix)), parameter("irradiance", tuple(colour)))
    half, away = min(light.angle / 2, math.radians(89.0)), FAR * size
    solid = math.pi * math.sin(half) ** 2  # the disk's solid angle, by the cosine
    direction = turned(matrix).to_3x3()
    place = Matrix.Translation(centre - away * direction.col[2]) @ direction.to_4x4() @ Matrix.Scale(away * math.tan(half), 4)
    return shape("disk", place, values(colour, solid if light.normalize else 1.0))


def element(export, thing, matrix, bounds):
    """A lamp at a place; None if it gives no light."""
    light = thing.data
    colour = strength(export, light, thing.name)
    if not any(colour):
        return None
    if min(colour) < 0.0:
        export.note(f"light {thing.name}", "what takes light away is left out")
        return None
    match light.type:
        case "POINT":
            return point(export, light, matrix, colour)
        case "SPOT":
            return spot(export, light, matrix, colour)
        case "AREA":
            return area(export, light, matrix, colour)
        case "SUN":
            return sun(export, light, matrix, colour, *bounds)
