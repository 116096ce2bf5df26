"""Driver: Mitsuba 3, by its Python module. `--variant NAME` chooses its variant (scalar_rgb by default).

A number becomes a flat reflectance, and a radiance whose red, green and blue are that number in every variant (in spectral
ones it scales the standard illuminant D65). Mitsuba's defaults have no bias (unlimited depth, unbiased roulette from the
fifth bounce on), so that `measure` and `shipped` are alike.
"""

import argparse

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import drjit as dr
import mitsuba as mi
import numpy as np


def surface(material):
    """A material as a BSDF, for both sides."""
    match material:
        case {"kind": "diffuse", "reflectance": rho}:
            bsdf = {"type": "diffuse", "reflectance": rho}
        case {"kind": "mirror", "reflectance": rho}:
            bsdf = {"type": "conductor", "material": "none", "specular_reflectance": rho}
        case {"kind": "conductor", "n": n, "k": k}:
            bsdf = {"type": "conductor", "eta": n, "k": k}
        case {"kind": "rough_conductor", "masking": "height_correlated"}:
            raise Unsupported("facets hide each other independently")
        case {"kind": "rough_conductor", "n": n, "k": k, "alpha": alpha}:
            bsdf = {"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "eta": n, "k": k}
        case {"kind": "glass", "n": n}:
            return {"type": "dielectric", "int_ior": n, "ext_ior": 1.0}
        case {"kind": "nothing"}:
            return {"type": "null"}
        case _:
            raise protocol.unknown("material", material)
    return {"type": "twosided", "bsdf": bsdf}


def placed(axes, origin):
    """The transform whose columns are these three axes, then the origin."""
    return mi.ScalarTransform4f(shapes.placed(axes, origin))


def mesh(positions, triangles, parts):
    """A mesh with flat faces and these parts (BSDF, emitter, medium)."""
    properties = mi.Properties()
    for name, part in parts.items():
        properties[name] = mi.load_dict(part)
    shape = mi.Mesh("mesh", len(positions), len(triangles), props=properties)
    parameters = mi.traverse(shape)
    parameters["vertex_positions"] = np.ravel(positions)
    parameters["faces"] = np.ravel(triangles)
    parameters.update()
    return shape


def body(item):
    """An object as a shape; area emitters shine from its outer side only, as they shall."""
    parts = {"bsdf": surface(item["material"])}
    if item["emitted_radiance"]:
        parts["emitter"] = {"type": "area", "radiance": item["emitted_radiance"]}
    if medium := item["interior"]:
        extinction = medium["absorption_per_m"] + medium["scattering_per_m"]
        albedo = medium["scattering_per_m"] / extinction if extinction else 0.0
        parts["interior"] = {"type": "homogeneous", "albedo": albedo, "sigma_t": extinction}
    match item["shape"]:
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            return {"type": "sphere", "center": center, "radius": radius, "flip_normals": inward, **parts}
        case {"kind": "quad", "center_m": center, "half_u_m": u, "half_v_m": v}:
            return {"type": "rectangle", "to_world": placed([u, v, shapes.unit(np.cross(u, v))], center), **parts}
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            return {"type": "cube", "to_world": placed(axes, center), **parts}
        case {"kind": "mesh", "positions_m": positions, "triangles": triangles}:
            return mesh(positions, triangles, parts)
    raise protocol.unknown("shape", item["shape"])


def light(item):
    """A light without extent as an emitter."""
    match item:
        case {"kind": "point", "position_m": position, "intensity": intensity}:
            return {"type": "point", "position": position, "intensity": intensity}
        case {"kind": "sun", "direction": direction, "irradiance": irradiance}:
            return {"type": "directional", "direction": direction, "irradiance": irradiance}
        case {"kind": "spot", "position_m": position, "target_m": target, "intensity": intensity}:
            if item.get("falloff") not in (None, "linear_in_angle"):
                raise Unsupported("spots fall off linearly in the angle")
            _, across, _ = shapes.frame(np.subtract(target, position))
            frame = mi.ScalarTransform4f().look_at(origin=position, target=target, up=across)
            return {"type": "spot", "to_world": frame, "intensity": intensity,
                    "beam_width": item["even_to_degrees"], "cutoff_angle": item["dark_from_degrees"]}
    raise protocol.unknown("light", item)


def camera(item, pixels):
    """The sensor, with a film of single precision and a box filter."""
    origin, target = item["origin_m"], item["target_m"]
    distance = float(np.linalg.norm(np.subtract(target, origin)))
    frame = mi.ScalarTransform4f().look_at(origin=origin, target=target, up=item["up"])
    film = {"type": "hdrfilm", "width": pixels, "height": pixels, "component_format": "float32", "filter": {"type": "box"}}
    sensor = {"film": film, "to_world": frame, "near_clip": 1e-3 * distance, "far_clip": 1e6 * distance}
    match item["projection"]:
        case {"kind": "orthographic", "width_m": width}:
            half = width / 2  # the film spans from -1 to 1 before it is scaled
            return {**sensor, "type": "orthographic", "to_world": frame @ mi.ScalarTransform4f().scale([half, half, 1])}
        case {"kind": "pinhole", "field_of_view_degrees": angle}:
            return {**sensor, "type": "perspective", "fov": angle}
        case {"kind": "thin_lens", "field_of_view_degrees": angle, "lens_radius_m": radius, "focus_distance_m": focus}:
            return {**sensor, "type": "thinlens", "fov": angle, "aperture_radius": radius, "focus_distance": focus}
    raise protocol.unknown("projection", item["projection"])


def sky(item):
    """What surrounds all, as an emitter. In maps +y is the zenith, and columns begin at -z and go on toward +x."""
    if item["kind"] == "even":
        return {"type": "constant", "radiance": item["radiance"]}
    if item["interpolation"] != "rows_to_poles":
        raise Unsupported("environment maps are bilinear, with rows at the poles, and this sky is not")
    up, first = np.array(item["zenith"]), np.array(item["meridian"])
    grey = np.array(item["radiance"], np.float32).reshape(item["rows"], item["columns"])[:, ::-1]
    bitmap = mi.Bitmap(np.repeat(grey[:, :, None], 3, axis=2))
    return {"type": "envmap", "bitmap": bitmap, "to_world": placed([-np.cross(up, first), up, -first], [0, 0, 0])}


def render(scene, job):
    """Renders a scene and writes the picture."""
    media = any(item["interior"] for item in scene["objects"])
    parts = {"type": "scene", "integrator": {"type": "volpath" if media else "path"}}
    parts["sensor"] = camera(scene["camera"], scene["pixels"])
    parts |= {f"object{i}": body(item) for i, item in enumerate(scene["objects"])}
    parts |= {f"light{i}": light(item) for i, item in enumerate(scene["lights"])}
    if scene["sky"]:
        parts["sky"] = sky(scene["sky"])
    dr.set_thread_count(job["threads"])
    picture = mi.render(mi.load_dict(parts), spp=job["samples"], seed=job["seed"])
    protocol.write_picture(job["out"], np.array(picture))


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--version", action="store_true", help="print the program's version")
    arguments.add_argument("--variant", default="scalar_rgb", help="Mitsuba's variant")
    chosen = arguments.parse_args().variant
    mi.set_variant(chosen)
    protocol.serve(lambda: f"Mitsuba {mi.__version__} ({chosen})", render)
