"""Driver: Radiance, by `oconv`, `vwrays` and `rtrace` of the Python wheel `pyradiance`, or of the search path.

The driver draws points of the pixels by the job's seed; `vwrays` makes rays of them, so that the camera is Radiance's own, and
`rtrace` follows them. As `rtrace` seeds its random numbers by the clock in whole seconds, each picture gets a second of its own.
"""

import fcntl
import importlib.util
import math
import os
import tempfile
import time
from pathlib import Path

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import numpy as np

TINY = 1e-6  # Radiance's FTINY: lengths that are not larger count as zero
POINT = 1e-3  # radius of the sphere that stands for a light without extent (m)
SUN = 0.1  # diameter of the disc that stands for a sun (degrees)
MEASURE = "-ab 1000 -aa 0 -ad 1 -as 0 -lr -1000 -lw 1e-4 -dj 1 -dt 0 -dc 1".split()


def run(*command, given=None):
    """What one of Radiance's programs writes."""
    environment = dict(os.environ)
    if wheel := importlib.util.find_spec("pyradiance"):
        folder = Path(wheel.origin).parent
        environment |= {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{folder / 'lib'}"}
    return protocol.run(*command, env=environment, input=given)


def primitive(kind, modifier, name, *values):
    """A primitive of the scene language whose arguments are numbers, or lists of them."""
    numbers = np.hstack([np.ravel(value) for value in values])
    return f"{modifier} {kind} {name} 0 0 {len(numbers)} " + " ".join(f"{number:.17g}" for number in numbers)


def material(item, name):
    """What an object scatters or emits, and what is inside."""
    medium, radiance, is_flat = item["interior"], item["emitted_radiance"], item["shape"]["kind"] in ("quad", "mesh")
    absorption = medium["absorption_per_m"] if medium else 0.0
    if medium and medium["scattering_per_m"]:
        raise Unsupported("media scatter the light of named lights only, and once")
    match item["material"]:
        case {"kind": "diffuse", "reflectance": 0.0} if radiance:
            return primitive("light", "void", name, [radiance] * 3)
        case _ if radiance:
            raise Unsupported("surfaces that glow do not reflect")
        case {"kind": "diffuse", "reflectance": rho}:
            return primitive("plastic", "void", name, [rho] * 3, 0, 0)
        case {"kind": "mirror", "reflectance": rho} if is_flat:
            return primitive("mirror", "void", name, [rho] * 3)
        case {"kind": "glass", "n": n}:
            return primitive("dielectric", "void", name, [math.exp(-absorption)] * 3, n, 0)
        case {"kind": "nothing"}:
            return primitive("mist", "void", name, [absorption] * 3, [0] * 3, 0)
        case {"kind": "mirror"}:
            raise Unsupported("mirrors are flat")
        case {"kind": "conductor" | "rough_conductor"}:
            raise Unsupported("there are no metals of given n and k")
        case other:
            raise protocol.unknown("material", other)


def body(item, name):
    """An object: its material and its surfaces."""
    match item["shape"]:
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            if radius <= TINY:
                raise Unsupported("radii of a millionth or less count as zero")
            return [material(item, name), primitive("bubble" if inward else "sphere", name, f"{name}s", center, radius)]
    corners, faces = shapes.polygons(item["shape"])
    return [material(item, name)] + [primitive("polygon", name, f"{name}s{i}", corners[[*face]]) for i, face in enumerate(faces)]


def light(item, name):
    """A light without extent, as a tiny sphere or disc."""
    match item:
        case {"kind": "sun", "direction": direction, "irradiance": irradiance}:
            radiance = irradiance / (math.pi * math.sin(math.radians(SUN / 2)) ** 2)
            disc = primitive("source", name, f"{name}s", -np.array(direction), SUN)
            return [primitive("light", "void", name, [radiance] * 3), disc]
        case {"kind": "point", "position_m": position, "intensity": intensity}:
            kind, beam = "light", []
        case {"kind": "spot", "position_m": position, "target_m": target, "intensity": intensity}:
            if item.get("falloff"):
                raise Unsupported("spots do not fall off, but end at an angle")
            axis = TINY * shapes.unit(np.subtract(target, position))  # its length is how far the focus lies behind the light
            kind, beam = "spotlight", [item["even_to_degrees"] + item["dark_from_degrees"], axis]
        case _:
            raise protocol.unknown("light", item)
    radiance = intensity / (math.pi * POINT**2)
    return [primitive(kind, "void", name, [radiance] * 3, *beam), primitive("sphere", name, f"{name}s", position, POINT)]


def sky(item):
    """An even sky, which is found by chance."""
    if item["kind"] != "even":
        raise protocol.unknown("sky", item)
    return [primitive("glow", "void", "sky", [item["radiance"]] * 3, 0), primitive("source", "sky", "skys", [0, 0, 1], 360)]


def rays(item, pixels, job):
    """Rays through random points of the pixels, pixel by pixel from the top."""
    forward, projection = np.subtract(item["target_m"], item["origin_m"]), item["projection"]
    match projection:
        case {"kind": "orthographic", "width_m": size}:
            kind = "l"
        case {"kind": "pinhole", "field_of_view_degrees": size}:
            kind = "v"
        case _:
            raise Unsupported("vwrays draws points of a lens without a seed, so that all pictures would share them")
    random = np.random.default_rng(job["seed"]).random((pixels, pixels, job["samples"], 2)) - 0.5  # from a pixel's middle
    columns, rows = np.arange(pixels)[None, :, None], np.arange(pixels)[::-1, None, None]  # vwrays counts rows from below
    points = np.stack([columns + random[..., 0], rows + random[..., 1]], -1).reshape(-1, 2)
    view = ["-vp", *item["origin_m"], "-vd", *forward, "-vu", *item["up"], f"-vt{kind}", "-vh", size, "-vv", size]
    lines = "\n".join(f"{x:.9f} {y:.9f}" for x, y in points.tolist())
    return run("vwrays", "-i", "-fd", *view, "-x", pixels, "-y", pixels, given=lines.encode())


def take_second():
    """Waits for a second in which no other picture begins: rtrace seeds its random numbers by the time in seconds."""
    with open(Path(tempfile.gettempdir()) / f"etalon-radiance-{os.getuid()}", "a+", encoding="ascii") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        last = int(file.read() or 0)
        while int(time.time()) <= last or time.time() % 1 > 0.9:  # near its end, rtrace might begin in the next
            time.sleep(0.01)
        file.truncate(0)
        file.write(str(int(time.time())))


def render(scene, job):
    """Renders a scene and writes the picture."""
    parts = [line for i, item in enumerate(scene["objects"]) for line in body(item, f"o{i}")]
    parts += [line for i, item in enumerate(scene["lights"]) for line in light(item, f"l{i}")]
    parts += sky(scene["sky"]) if scene["sky"] else []
    pixels, options = scene["pixels"], MEASURE if job["mode"] == "measure" else []
    with tempfile.TemporaryDirectory() as folder:
        octree = Path(folder) / "scene.oct"
        octree.write_bytes(run("oconv", "-", given="\n".join(parts).encode()))
        directions = rays(scene["camera"], pixels, job)
        if any(map(shapes.is_diffuse, scene["objects"])):
            take_second()
        values = run("rtrace", "-h", "-w", "-fdd", *options, octree, given=directions)
    protocol.write_picture(job["out"], np.frombuffer(values).reshape(pixels, pixels, job["samples"], 3).mean((2, 3)))


if __name__ == "__main__":
    protocol.serve(lambda: f"Radiance {run('rtrace', '-version').decode().split()[1]}", render)
