"""Driver: LuxCore, by the module `pyluxcore`.

Facts that it rests on, from LuxCore's source: an emission's gain is radiance, a sharp distant light's irradiance; a point or a
sphere of gain G has the intensity G/4π; a spot's gain is its intensity; light leaves a triangle on the side of its normal only.
There are no spheres but lamps, which no ray finds: a black sphere that shines becomes one where all is diffuse, all others
become fine meshes of the same area. The film has its lowest row first, as a portable float map has.
"""

import itertools
import math
import os
import time

import protocol
from protocol import Unsupported

import numpy as np  # before pyluxcore, which ends Python if it comes first
import pyluxcore

BLACK = {"kind": "diffuse", "reflectance": 0.0}
CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
FACES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


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
        case {"kind": "glass", "n": n}:
            settings = {"type": "glass", "kr": grey(1), "kt": grey(1), "interiorior": float(n), "exteriorior": 1.0}
        case {"kind": "nothing"}:
            settings = {"type": "null"}
        case {"kind": kind}:
            raise Unsupported(f"the material {kind} is not known")
    if item["emitted_radiance"]:
        settings |= {"emission": grey(1), "emission.gain": grey(item["emitted_radiance"])}
    if item["interior"]:
        absorption, scattering = item["interior"]["absorption_per_m"], item["interior"]["scattering_per_m"]
        volume = {"type": "homogeneous", "absorption": grey(absorption), "scattering": grey(scattering), "multiscattering": True}
        extra |= prefixed(f"scene.volumes.{name}-inside", volume)
        settings["volume.interior"] = f"{name}-inside"
    return extra | prefixed(f"scene.materials.{name}", settings)


def icosphere():
    """Corners of 20,480 triangles, an icosahedron's divided, with the area of the unit sphere."""
    points = [np.roll((0, a, b * (1 + math.sqrt(5)) / 2), turn) for turn in range(3) for a in (-1, 1) for b in (-1, 1)]
    near = lambda corners: all(math.dist(p, q) < 2.1 for p, q in itertools.combinations(corners, 2))
    triples = np.array([corners for corners in itertools.combinations(points, 3) if near(corners)])
    triples = np.where(np.linalg.det(triples)[:, None, None] > 0, triples, triples[:, ::-1])
    triples /= np.linalg.norm(triples, axis=-1, keepdims=True)
    for _ in range(5):
        a, b, c = triples.transpose(1, 0, 2)
        ab, bc, ca = ((p + q) / np.linalg.norm(p + q, axis=-1, keepdims=True) for p, q in ((a, b), (b, c), (c, a)))
        triples = np.concatenate([np.stack(corners, 1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    a, b, c = triples.transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return triples * math.sqrt(4 * math.pi / area)


def triangles(shape):
    """Corners and triangles of a shape, which turn to the left from outside."""
    match shape:
        case {"kind": "quad", "center_m": center, "half_u_m": u, "half_v_m": v}:
            return np.add(center, np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ [u, v]), [(0, 1, 2), (0, 2, 3)]
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            return np.add(center, np.array(CORNERS) @ axes), FACES
        case {"kind": "mesh", "positions_m": positions, "triangles": faces}:
            return np.array(positions), faces
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            corners = (icosphere()[:, ::-1] if inward else icosphere()).reshape(-1, 3)
            return np.add(center, radius * corners), np.arange(len(corners)).reshape(-1, 3).tolist()
    raise Unsupported(f"the shape {shape['kind']} is not known")


def body(scene, name, item):
    """Puts the mesh of an object into the scene and returns its settings."""
    corners, faces = triangles(item["shape"])
    scene.DefineMesh(f"{name}-mesh", list(map(tuple, corners.tolist())), list(map(tuple, faces)), None, None, None, None)
    return material(name, item) | prefixed(f"scene.objects.{name}", {"material": name, "shape": f"{name}-mesh"})


def sphere_lamp(scene, name, item, eye):
    """A black sphere that shines, as a lamp. Lamps block no light, so that a black core just beneath its surface does, unless
    the sphere looks so small that it blocks next to nothing (and single precision could not tell the two surfaces apart)."""
    center, radius = item["shape"]["center_m"], item["shape"]["radius_m"]
    gain = 4 * math.pi**2 * radius**2 * item["emitted_radiance"]
    settings = prefixed(f"scene.lights.{name}", {"type": "sphere", "position": center, "radius": radius, "gain": grey(gain)})
    if radius > 0.01 * math.dist(center, eye):
        core = {"shape": item["shape"] | {"radius_m": 0.999 * radius}, "material": BLACK, "emitted_radiance": 0, "interior": None}
        settings |= body(scene, name, core)
    return settings


def light(name, item):
    """A light without extent."""
    match item:
        case {"kind": "point", "position_m": position, "intensity": intensity}:
            settings = {"type": "point", "position": position, "gain": grey(4 * math.pi * intensity)}
        case {"kind": "sun", "direction": direction, "irradiance": irradiance}:
            settings = {"type": "sharpdistant", "direction": direction, "gain": grey(irradiance)}
        case {"kind": "spot", "position_m": position, "target_m": target, "intensity": intensity}:
            even, dark = item["even_to_degrees"], item["dark_from_degrees"]
            settings = {"type": "spot", "position": position, "target": target, "gain": grey(intensity)}
            settings |= {"coneangle": dark, "conedeltaangle": dark - even}
        case {"kind": kind}:
            raise Unsupported(f"the light {kind} is not known")
    return prefixed(f"scene.lights.{name}", settings)


def sky(item):
    """What surrounds all."""
    if not item:
        return {}
    if item["kind"] != "even":
        raise Unsupported(f"the sky {item['kind']} is not known to the driver")
    return prefixed("scene.lights.sky", {"type": "constantinfinite", "gain": grey(item["radiance"])})


def camera(item):
    """The camera."""
    settings = {"lookat.orig": item["origin_m"], "lookat.target": item["target_m"], "up": item["up"]}
    match item["projection"]:
        case {"kind": "orthographic", "width_m": width}:
            settings |= {"type": "orthographic", "screenwindow": [-width / 2, width / 2, -width / 2, width / 2]}
        case {"kind": "pinhole" | "thin_lens", "field_of_view_degrees": angle}:
            settings |= {"type": "perspective", "fieldofview": angle}
        case {"kind": kind}:
            raise Unsupported(f"the projection {kind} is not known")
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


def render(scene, job):
    """Renders a scene and writes the picture."""
    lux, result, eye = pyluxcore.Scene(), {}, scene["camera"]["origin_m"]
    diffuse = all(item["material"]["kind"] == "diffuse" for item in scene["objects"])
    for index, item in enumerate(scene["objects"]):
        sphere = item["shape"]["kind"] == "sphere" and not item["shape"]["inward"]
        if sphere and diffuse and item["material"] == BLACK and item["emitted_radiance"]:
            result |= sphere_lamp(lux, f"object{index}", item, eye)
        else:
            result |= body(lux, f"object{index}", item)
    for index, item in enumerate(scene["lights"]):
        result |= light(f"light{index}", item)
    lux.Parse(properties(result | sky(scene["sky"]) | camera(scene["camera"])))
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(configuration(job, scene["pixels"])), lux))
    session.Start()
    while not session.HasDone():
        time.sleep(0.005)
        session.UpdateStats()
    session.Stop()
    picture = np.zeros(3 * scene["pixels"] ** 2, np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, picture)
    with open(job["out"], "wb") as file:
        file.write(f"PF\n{scene['pixels']} {scene['pixels']}\n-1.0\n".encode())
        picture.astype("<f4").tofile(file)


if __name__ == "__main__":
    pyluxcore.Init(lambda message: None)
    protocol.serve(lambda: f"LuxCore {pyluxcore.Version()}", render)
    os._exit(0)  # at an ordinary end the module aborts, since it still wants to say something
