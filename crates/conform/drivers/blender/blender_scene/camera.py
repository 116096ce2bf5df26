"""The camera, its film, and how many samples it takes.

Blender's cameras look along −z, with +x on the right; Etalon's along +z, with +x on the left. The frame that Blender draws says
where the borders of the picture are, whatever its fit to the sensor, its shift and the shape of its pixels.
"""

import math

from mathutils import Matrix

from .elements import boolean, integer, parameter, plugin, string, transform

DEVIATION = {"GAUSSIAN": 0.25, "BLACKMAN_HARRIS": 0.277}  # of Cycles' filters in their widths; the latter is nearly Gaussian


def frame(export, data):
    """The borders of the picture at the distance 1 (of parallel rays: at any): left, right, below, above."""
    corners = data.view_frame(scene=export.scene)
    deep = 1.0 if data.type == "ORTHO" else -corners[0].z
    across, up = ([corner[axis] / deep for corner in corners] for axis in (0, 1))
    return min(across), max(across), min(up), max(up)


def film(export):
    """Its size, and the filter of its pixels."""
    scene, render = export.scene, export.scene.render
    if render.use_border:
        export.note("scene", "the whole picture is rendered, not the part in its border")
    if (render.pixel_aspect_x, render.pixel_aspect_y) != (1.0, 1.0):
        export.note("scene", "pixels are square here")
    size = [int(side * render.resolution_percentage / 100) for side in (render.resolution_x, render.resolution_y)]
    kind, width = scene.cycles.pixel_filter_type, scene.cycles.filter_width
    if kind == "BOX":
        rfilter = plugin("rfilter", "box", parameter("radius", width / 2) if width != 1.0 else None)
    else:
        rfilter = plugin("rfilter", "gaussian", parameter("stddev", DEVIATION[kind] * width))
    shows = string("pixel_format", "rgba" if render.film_transparent else "rgb")
    return plugin("film", "hdrfilm", integer("width", size[0]), integer("height", size[1]), shows, rfilter)


def element(export, thing, matrix):
    """The camera of the scene."""
    data = thing.data
    left, right, below, above = frame(export, data)
    place, turn, _ = matrix.decompose()
    to_world = Matrix.LocRotScale(place, turn, None) @ Matrix.Diagonal((-1.0, 1.0, -1.0, 1.0))
    parts = [parameter("near_clip", data.clip_start), parameter("far_clip", data.clip_end), film(export)]
    parts.append(plugin("sampler", "sobol", integer("sample_count", export.scene.cycles.samples)))
    if export.scene.render.use_motion_blur:
        export.note("scene", "motion blur is left out")
    middle = (left + right) / 2, (below + above) / 2
    wide, high = right - left, above - below
    if data.type == "ORTHO":
        shifted = Matrix.Translation((-middle[0], middle[1], 0.0)) @ Matrix.Diagonal((wide / 2, wide / 2, 1.0, 1.0))
        return plugin("sensor", "orthographic", transform("to_world", to_world @ shifted), *parts)
    if data.type != "PERSP":
        raise ValueError(f"camera {thing.name}: panoramas are not exported; accepted are perspective and orthographic cameras")
    parts += [transform("to_world", to_world), parameter("fov", math.degrees(2 * math.atan(wide / 2)))]
    if any(middle):
        parts.append(parameter("principal_point_offset_x", middle[0] / wide))
        parts.append(parameter("principal_point_offset_y", -middle[1] / high))
    if not data.dof.use_dof:
        return plugin("sensor", "perspective", *parts)
    if data.dof.aperture_blades or data.dof.aperture_ratio != 1.0:
        export.note(f"camera {thing.name}", "its aperture is round")
    radius = data.lens / 1000.0 / (2.0 * data.dof.aperture_fstop)
    parts += [parameter("aperture_radius", radius), parameter("focus_distance", focus(data, to_world))]
    return plugin("sensor", "thinlens", *parts)


def focus(data, to_world):
    """The distance of the plane in focus."""
    if data.dof.focus_object is None:
        return data.dof.focus_distance
    away = data.dof.focus_object.matrix_world.translation - to_world.translation
    return abs(away.dot(to_world.col[2].to_3d()))


def integrator(export):
    """Paths of as many segments as Cycles has bounces, and one more."""
    hides = boolean("hide_emitters", True) if export.hides_lamps or export.scene.render.film_transparent else None
    return plugin("integrator", "path", integer("max_depth", export.scene.cycles.max_bounces + 1), hides)
