"""Driver: LuxCore, by the module `pyluxcore`.

Facts that it rests on, from LuxCore's source: an emission's gain is radiance, a sharp distant light's irradiance; a point or a
sphere of gain G has the intensity G/4π; a spot's gain is its intensity; light leaves a triangle on the side of its normal only.
There are no spheres but lamps, which no ray finds: a black sphere that shines becomes one where all is diffuse, all others
become fine meshes of the same area.
"""

import math
import os
import tempfile
import time

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import numpy as np  # before pyluxcore, which ends Python if it comes first
import pyluxcore


def grey(value):
    """A colour."""
    return [float(value)] * 3


def prefixed(prefix, settings):
    """Settings whose names begin with this."""
    return {f"{prefix}.{name}": value for name, value in settings.items()}


def properties(settings):
    """Settings as LuxCore takes them."""
    result = pyluxcore.Properties()
    for name, value in settings.items():
        result.Set(pyluxcore.Property(name, value))
    return result


def material(name, item):
    """The material of an object: how it scatters, what it emits, and what is inside."""
    extra = {}
    match item["material"]:
        case {"kind": "diffuse", "reflectance": rho}:
            settings = {"type": "matte", "kd": grey(rho)}
        case {"kind": "mirror", "reflectance": rho}:
            settings = {"type": "mirror", "kr": grey(rho)}
        case {"kind": "conductor", "n": n, "k": k}:  # there is no smooth metal
            extra = prefixed(f"scene.textures.{name}-fresnel", {"type": "fresnelconst", "n": grey(n), "k": grey(k)})
            settings = {"type": "metal2", "fresnel": f"{name}-fresnel", "uroughness": 1e-4, "vroughness": 1e-4}
        case {"kind": "rough_conductor"}:
            raise Unsupported("facets have Schlick's distribution")
        case {"kind": "glass", "n": n}:
            settings = {"type": "glass", "kr": grey(1), "kt": grey(1), "interiorior": float(n), "exteriorior": 1.0}
        case {"kind": "nothing"}:
            settings = {"type": "null"}
        case other:
            raise protocol.unknown("material", other)
    if item["emitted_radiance"]:
        settings |= {"emission": grey(1), "emission.gain": grey(item["emitted_radiance"])}
    if item["interior"]:
        absorption, scattering = item["interior"]["absorption_per_m"], item["interior"]["scattering_per_m"]
        volume = {"type": "homogeneous", "absorption": grey(absorption), "scattering": grey(scattering), "multiscattering": True}
        extra |= prefixed(f"scene.volumes.{name}-inside", volume)
        settings["volume.interior"] = f"{name}-inside"
    return extra | prefixed(f"scene.materials.{name}", settings)


def body(scene, name, item):
    """Puts the mesh of an object into the scene and returns its settings."""
    corners, faces = shapes.triangles(item["shape"])
    scene.DefineMesh(f"{name}-mesh", list(map(tuple, corners.tolist())), faces, None, None, None, None)
    return material(name, item) | prefixed(f"scene.objects.{name}", {"material": name, "shape": f"{name}-mesh"})


def sphere_lamp(name, item):
    """A black ball that shines, as a lamp, which blocks no light."""
    center, radius = item["shape"]["center_m"], item["shape"]["radius_m"]
    gain = 4 * math.pi**2 * radius**2 * item["emitted_radiance"]
    return prefixed(f"scene.lights.{name}", {"type": "sphere", "position": center, "radius": radius, "gain": grey(gain)})


def light(name, item):
    """A light without extent."""
    match item:
        case {"kind": "point", "position_m": position, "intensity": intensity}:
            settings = {"type": "point", "position": position, "gain": grey(4 * math.pi * intensity)}
        case {"kind": "sun", "direction": direction, "irradiance": irradiance}:
            settings = {"type": "sharpdistant", "direction": direction, "gain": grey(irradiance)}
        case {"kind": "spot", "position_m": position, "target_m": target, "intensity": intensity}:
            if item.get("falloff") not in (None, "quartic_in_cosine"):
                raise Unsupported("spots fall off by the fourth power in the cosine")
            even, dark = item["even_to_degrees"], item["dark_from_degrees"]
            settings = {"type": "spot", "position": position, "target": target, "gain": grey(intensity)}
            settings |= {"coneangle": dark, "conedeltaangle": dark - even}
        case _:
            raise protocol.unknown("light", item)
    return prefixed(f"scene.lights.{name}", settings)


def sky(item, file):
    """What surrounds all. A map is written to this file: its rows begin at +z, and its columns at +x and go on toward +y."""
    if item["kind"] == "even":
        return prefixed("scene.lights.sky", {"type": "constantinfinite", "gain": grey(item["radiance"])})
    interpolation = {"none": "nearest", "linear": "linear"}.get(item["interpolation"])
    if not interpolation:
        raise Unsupported("environment maps have rows in the middle of their cells, and this sky has not")
    protocol.write_picture(file, np.reshape(item["radiance"], (item["rows"], item["columns"])))
    up, first = np.array(item["zenith"]), np.array(item["meridian"])
    columns = shapes.placed([first, np.cross(up, first), up], [0, 0, 0]).T.ravel().tolist()
    settings = {"type": "infinite", "file": file, "gamma": 1.0, "filter": interpolation, "transformation": columns}
    return prefixed("scene.lights.sky", settings)


def camera(item):
    """The camera."""
    settings = {"lookat.orig": item["origin_m"], "lookat.target": item["target_m"], "up": item["up"]}
    match item["projection"]:
        case {"kind": "orthographic", "width_m": width}:
            settings |= {"type": "orthographic", "screenwindow": [-width / 2, width / 2, -width / 2, width / 2]}
        case {"kind": "pinhole" | "thin_lens", "field_of_view_degrees": angle}:
            settings |= {"type": "perspective", "fieldofview": angle}
        case other:
            raise protocol.unknown("projection", other)
    if "lens_radius_m" in item["projection"]:
        settings |= {"lensradius": item["projection"]["lens_radius_m"], "focaldistance": item["projection"]["focus_distance_m"]}
    return prefixed("scene.camera", settings)


def configuration(job, pixels):
    """Samples, seed, film; and in the mode `measure` all off that has a bias."""
    result = {"renderengine.type": "PATHCPU", "renderengine.seed": job["seed"], "native.threads.count": job["threads"]}
    result |= {"film.width": pixels, "film.height": pixels, "film.filter.type": "BOX", "film.filter.width": 0.5}
    result |= {"batch.haltspp": [job["samples"], 0]}
    if job["mode"] == "measure":
        result |= {"path.clamping.variance.maxvalue": 0.0, "sampler.sobol.adaptive.strength": 0.0}
        result |= {f"path.pathdepth.{kind}": 128 for kind in ("total", "diffuse", "glossy", "specular")}
    return result


def define(scene):
    """The scene as LuxCore takes it."""
    lux, settings = pyluxcore.Scene(), camera(scene["camera"])
    diffuse = all(item["material"]["kind"] == "diffuse" for item in scene["objects"])  # else a mirror might have to show a lamp
    for index, item in enumerate(scene["objects"]):
        solids = [item]
        if diffuse and shapes.is_lamp(item):
            settings |= sphere_lamp(f"object{index}", item)
            solids = shapes.core(item, scene["camera"]["origin_m"])
        for solid in solids:
            settings |= body(lux, f"object{index}", solid)
    for index, item in enumerate(scene["lights"]):
        settings |= light(f"light{index}", item)
    with tempfile.NamedTemporaryFile(suffix=".pfm") as file:
        if scene["sky"]:
            settings |= sky(scene["sky"], file.name)
        lux.Parse(properties(settings))
    return lux


def render(scene, job):
    """Renders a scene and writes the picture."""
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(configuration(job, scene["pixels"])), define(scene)))
    session.Start()
    while not session.HasDone():
        time.sleep(0.005)
        session.UpdateStats()
    session.Stop()
    picture = np.zeros((scene["pixels"], scene["pixels"], 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, picture)
    protocol.write_picture(job["out"], picture[::-1])  # the film has its bottom row first


if __name__ == "__main__":
    pyluxcore.Init(lambda message: None)
    protocol.serve(lambda: f"LuxCore {pyluxcore.Version()}", render)
    os._exit(0)  # at an ordinary end the module aborts, since it still wants to say something
