"""Driver: Raysect, by its Python module.

Facts that it rests on: only surfaces and volumes emit, and materials return spectral radiance, so that with one spectral bin of
1 nm what is observed is that number; cameras look along their +z axis, +y is up and +x to the left; a pinhole weighs each ray by
the cosine of its angle from the axis. There are no rectangles: each is a face of a very thin box, since meshes are of single
precision and large ones shade themselves. Glowing bodies are found by importance sampling, as is Raysect's default.
"""

import math
import random
from importlib.metadata import version

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import numpy as np
from raysect.core import AffineMatrix3D, Point3D, translate
from raysect.core.math.random import seed
from raysect.core.workflow import SerialEngine
from raysect.optical import ConstantSF, World
from raysect.optical.material import AbsorbingSurface, Add, Blend, Conductor, Dielectric, Lambert, NullVolume, RoughConductor
from raysect.optical.material.debug import PerfectReflectingSurface
from raysect.optical.observer import FullFrameSampler2D, OrthographicCamera, PinholeCamera, RadiancePipeline2D
from raysect.primitive import Box, Mesh, Sphere

THIN = 1e-6  # depth of the box whose face is a rectangle, in half widths of it
FAR = 1e4  # radius of the sphere that stands for a sky, in distances of the camera from its target


class Glow(NullVolume):
    """Emits evenly, from a shape's outer side only. (Raysect 0.9.1's own emitter of that kind takes one side for the other.)"""

    def __init__(self, radiance, shape):
        super().__init__()
        self.radiance, self.inward, self.slab = radiance, shape.get("inward", False), shape["kind"] == "quad"
        self.importance = 1.0  # as Raysect's own emitters

    def evaluate_surface(self, world, ray, primitive, hit_point, exiting, inside_point, outside_point, normal, *_):
        spectrum = ray.new_spectrum()
        shines = exiting == self.inward and not (self.slab and normal.z < 0.5)
        spectrum.samples[:] = self.radiance if shines else 0.0
        return spectrum


def surface(material, medium):
    """A material, with what is inside."""
    if medium and medium["scattering_per_m"]:
        raise Unsupported("no medium scatters light")
    transmission = ConstantSF(math.exp(-medium["absorption_per_m"]) if medium else 1.0)  # of a metre
    match material:
        case {"kind": "diffuse", "reflectance": rho}:
            return Lambert(ConstantSF(rho))
        case {"kind": "mirror", "reflectance": 1.0}:
            return PerfectReflectingSurface()
        case {"kind": "mirror", "reflectance": rho}:  # a mirror for this fraction of the rays
            return Blend(AbsorbingSurface(), PerfectReflectingSurface(), rho, surface_only=True)
        case {"kind": "conductor", "n": n, "k": k}:
            return Conductor(ConstantSF(n), ConstantSF(k))
        case {"kind": "rough_conductor", "masking": "height_correlated"}:
            raise Unsupported("facets hide each other independently")
        case {"kind": "rough_conductor", "n": n, "k": k, "alpha": alpha}:
            return RoughConductor(ConstantSF(n), ConstantSF(k), alpha)
        case {"kind": "glass", "n": n}:
            return Dielectric(ConstantSF(n), transmission)
        case {"kind": "nothing"}:
            return Dielectric(ConstantSF(1.0), transmission)
    raise protocol.unknown("material", material)


def shaded(item):
    """What an object scatters and emits."""
    scattered, radiance = surface(item["material"], item["interior"]), item["emitted_radiance"]
    if not radiance:
        return scattered
    glow = Glow(radiance, item["shape"])
    return glow if item["material"] == shapes.BLACK else Add(scattered, glow, surface_only=True)


def placed(axes, origin):
    """The transform whose columns are these three axes, then the origin."""
    return AffineMatrix3D(shapes.placed(axes, origin).tolist())


def body(item, world):
    """Puts an object into the world."""
    material = shaded(item)
    closed = bool(item["interior"]) or item["material"]["kind"] == "glass"  # whether a mesh has an inside
    match item["shape"]:
        case {"kind": "sphere", "center_m": center, "radius_m": radius}:
            Sphere(radius, world, translate(*center), material)
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            half = np.linalg.norm(axes, axis=1)
            Box(Point3D(*-half), Point3D(*half), world, placed(np.array(axes) / half[:, None], center), material)
        case {"kind": "quad", "center_m": center, "half_u_m": u, "half_v_m": v} if abs(np.dot(u, v)) < 1e-9 * np.dot(u, u):
            a, b = np.linalg.norm(u), np.linalg.norm(v)
            frame = placed([u / a, v / b, np.cross(u / a, v / b)], center)
            Box(Point3D(-a, -b, -THIN * min(a, b)), Point3D(a, b, 0), world, frame, material)
        case {"kind": "mesh", "positions_m": positions, "triangles": triangles}:
            Mesh(positions, triangles, smoothing=False, closed=closed, parent=world, material=material)
        case shape:
            raise Unsupported(f"the shape {shape['kind']} is not known, or not rectangular")


def sky(item, center, distance, world):
    """An even sky: the inside of a very large sphere that glows."""
    if item["kind"] != "even":
        raise protocol.unknown("sky", item)
    Sphere(FAR * distance, world, translate(*center), Glow(item["radiance"], {"kind": "sphere", "inward": True}))


def pinhole_weights(angle, pixels):
    """The mean cosine of the rays of each pixel, from 8 × 8 points: a pinhole weighs by it."""
    edge = math.tan(math.radians(angle) / 2)
    x = edge * ((np.arange(8 * pixels) + 0.5) / (4 * pixels) - 1)
    cosines = 1 / np.sqrt(1 + x[:, None] ** 2 + x**2)
    return cosines.reshape(pixels, 8, pixels, 8).mean((1, 3))


def camera(item, pixels, pipeline):
    """The camera, and the weights that it gives its pixels."""
    right, up, forward = shapes.frame(np.subtract(item["target_m"], item["origin_m"]), item["up"])
    frame = placed([-right, up, forward], item["origin_m"])
    settings = {"pipelines": [pipeline], "frame_sampler": FullFrameSampler2D(), "transform": frame}
    match item["projection"]:
        case {"kind": "orthographic", "width_m": width}:
            return OrthographicCamera((pixels, pixels), width, **settings), 1.0
        case {"kind": "pinhole", "field_of_view_degrees": angle}:
            return PinholeCamera((pixels, pixels), fov=angle, **settings), pinhole_weights(angle, pixels)
        case projection:
            raise Unsupported(f"there is no camera of the projection {projection['kind']}")


def render(scene, job):
    """Renders a scene and writes the picture."""
    if scene["lights"]:
        raise Unsupported("there are no lights without extent")
    world, pipeline, view = World(), RadiancePipeline2D(accumulate=False, display_progress=False), scene["camera"]
    for item in scene["objects"]:
        body(item, world)
    if scene["sky"]:
        sky(scene["sky"], view["target_m"], math.dist(view["origin_m"], view["target_m"]), world)
    observer, weights = camera(view, scene["pixels"], pipeline)
    observer.parent, observer.render_engine, observer.quiet = world, SerialEngine(), True
    observer.pixel_samples, observer.spectral_bins = job["samples"], 1
    observer.min_wavelength, observer.max_wavelength = 500.0, 501.0  # nm
    if job["mode"] == "measure":  # no end of paths but roulette, which has no bias
        observer.ray_max_depth, observer.ray_extinction_prob = 10_000, 0.05
    seed(job["seed"])
    random.seed(job["seed"])  # the pixels are taken in the order of a shuffle
    observer.observe()
    protocol.write_picture(job["out"], pipeline.frame.mean.T / weights)  # its columns come first


if __name__ == "__main__":
    protocol.serve(lambda: f"Raysect {version('raysect')}", render)
