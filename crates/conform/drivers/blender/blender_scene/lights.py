"""Lamps, from Blender's watts to radiance, intensity and irradiance.

A lamp of the power P (W) gives, in each of the three channels, what Cycles' has (as questions with known answers show):

| lamp | |
|---|---|
| point, spot | the intensity P/4π, whatever the cone of a spot; a point of radius r is a sphere of the radiance P/(4π² r²) |
| area of A m² | the radiance P/(π A) to one side |
| sun | its strength is irradiance E; of an angle α, a disk far away of the radiance E/(π sin²(α/2)) |

Without `normalize` the division by the size falls away: a sphere or an area has the radiance P/π, a disk of the sun E; what
has no radius counts as one of 1 m. Lamps cast no shadows, so their shapes are of the material `null`; and Blender's cameras do
not see them.
"""

import math

from bpy_extras.object_utils import world_to_camera_view
from mathutils import Matrix

from .elements import parameter, plugin, string, transform
from .inputs import output, uses_nodes

FAR = 1000.0  # how many sizes of the scene a sun of some extent is away
MARGIN = 0.1  # how far beyond the picture a lamp's middle still counts as in it, in pictures


def strength(export, light, name):
    """Energy times colour, with what the lamp's nodes add."""
    factor = light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    colour = [factor * part for part in light.color]
    if getattr(light, "use_temperature", False):
        colour = [part * warmth for part, warmth in zip(colour, light.temperature_color)]
    if uses_nodes(light):
        end = output(light, "Surface")
        node = end.source() if end else None
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


def is_normalized(light):
    """Whether its strength is that of the whole lamp; before 4.5 Blender had no other."""
    return getattr(light, "normalize", True)


def intensity(light, colour):
    """That of a point or a spot."""
    radius = light.shadow_soft_size
    return values(colour, 4 * math.pi if is_normalized(light) else math.pi if radius == 0.0 else 1.0 / radius**2)


def point(light, matrix, colour, sharp):
    """A point, or a sphere."""
    radius = light.shadow_soft_size
    place = Matrix.Translation(matrix.translation)
    if sharp or radius == 0.0:
        strength = parameter("intensity", intensity(light, colour))
        return plugin("emitter", "point", transform("to_world", place), strength)
    divisor = math.pi * (4 * math.pi * radius**2 if is_normalized(light) else 1.0)
    return shape("sphere", place @ Matrix.Scale(radius, 4), values(colour, divisor))


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
        parameter("intensity", intensity(light, colour)),
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
    radiance = values(colour, math.pi * (extent if is_normalized(light) else 1.0))
    return shape("disk" if round_one else "rectangle", place, radiance)


def sun(light, matrix, colour, bounds, sharp):
    """Parallel light, or a disk far away."""
    half = min(light.angle / 2, math.radians(89.0))
    solid = math.pi * math.sin(half) ** 2  # the disk's solid angle, by the cosine
    whole = is_normalized(light) or half == 0.0  # whether the strength is irradiance, not radiance
    if sharp or half == 0.0:
        irradiance = parameter("irradiance", values(colour, 1.0 if whole else 1.0 / solid))
        return plugin("emitter", "directional", transform("to_world", turned(matrix)), irradiance)
    centre, size = bounds
    direction, away = turned(matrix).to_3x3(), FAR * size
    middle = Matrix.Translation(centre - away * direction.col[2])
    place = middle @ direction.to_4x4() @ Matrix.Scale(away * math.tan(half), 4)
    return shape("disk", place, values(colour, solid if whole else 1.0))


def is_seen(export, thing, matrix):
    """Whether the camera would see what shines, where Blender hides it; a lamp counts by its middle."""
    light, eye = thing.data, export.scene.camera
    if thing.visible_camera or light.type == "SPOT" or export.hides_lamps:
        return False
    middle = matrix.translation
    if light.type == "SUN":
        middle = eye.matrix_world.translation + matrix.col[2].to_3d().normalized() * eye.data.clip_end
    elif light.type == "AREA" and matrix.col[2].to_3d().dot(middle - eye.matrix_world.translation) >= 0.0:
        return False  # from behind
    across, up, depth = world_to_camera_view(export.scene, eye, middle)
    return depth > 0.0 and -MARGIN < across < 1.0 + MARGIN and -MARGIN < up < 1.0 + MARGIN


def element(export, thing, matrix, bounds):
    """A lamp at a place; None if it gives no light."""
    light, name = thing.data, f"light {thing.name}"
    colour = strength(export, light, thing.name)
    if not any(colour) or light.type == "AREA" and light.cycles.is_portal:  # a portal only guides the sky's light
        return None
    if not light.use_shadow:
        export.note(name, "all lamps cast shadows here")
    if min(colour) < 0.0:
        export.note(name, "what takes light away is left out")
        return None
    seen = is_seen(export, thing, matrix)
    if light.type == "SPOT":
        return spot(export, light, matrix, colour)
    if light.type == "AREA":
        if seen:
            export.note(name, "it is in the picture, where Blender does not show it")
        return area(export, light, matrix, colour)
    if seen and (light.angle if light.type == "SUN" else light.shadow_soft_size):
        export.note(name, "it would be in the picture, where Blender does not show it: it has no extent here, and sharp shadows")
    return sun(light, matrix, colour, bounds, seen) if light.type == "SUN" else point(light, matrix, colour, seen)
