"""Driver: POV-Ray 3.7, by its command line.

POV-Ray draws no random numbers here: each pixel is the mean of a regular grid of about `samples` rays. A seed only shifts that
grid, evenly within one of its cells, which makes the mean over seeds that of a box filter.
Its radiosity looks in few, fixed directions, so that only what it traces exactly is supported: glowing surfaces seen directly,
in mirrors or through glass, and one convex diffuse body under lights without extent.
"""

import math
import re
import subprocess
import tempfile
from pathlib import Path

import shapes  # before `protocol`, which takes this folder off the search path
import protocol
from protocol import Unsupported

import numpy as np

FADE = 1e-4  # light falls as 2/(1 + (d/FADE)²), which is 2 FADE²/d² at all distances that matter (m)


def vector(triple):
    """A vector in POV-Ray's language."""
    return "<" + ",".join(f"{value:.17g}" for value in triple) + ">"


def refuse_indirect(scene):
    """Refuses a scene in which a diffuse surface gets light other than straight from a light without extent."""
    diffuse = [item for item in scene["objects"] if shapes.is_diffuse(item)]
    if not diffuse:
        return
    if scene["sky"] or any(item["emitted_radiance"] for item in scene["objects"]):
        raise Unsupported("light from surfaces or a sky reaches diffuse surfaces by radiosity only, which is an approximation")
    if len(diffuse) > 1 or diffuse[0]["shape"].get("inward") or diffuse[0]["shape"]["kind"] == "mesh":
        raise Unsupported("light between diffuse surfaces is found by radiosity only, which is an approximation")
    if any(item["material"]["kind"] != "diffuse" for item in scene["objects"]):
        raise Unsupported("light that mirrors or glass throw on diffuse surfaces is not traced")


def finish(item):
    """How a surface scatters and emits: a texture for its outer side, one for its inner side, and the interior."""
    material, medium = item["material"], item["interior"] or {"absorption_per_m": 0, "scattering_per_m": 0}
    pigment, interior = "rgb 1", ""
    match material:
        case {"kind": "diffuse", "reflectance": rho}:
            scatter = f"diffuse {rho:.17g}"
        case {"kind": "mirror", "reflectance": rho}:
            scatter = f"diffuse 0 reflection {rho:.17g}"
        case {"kind": "glass", "n": n}:
            pigment, interior = "rgbt 1", f"ior {n:.17g} "
            scatter = "diffuse 0 specular 0 reflection { 0 1 fresnel on } conserve_energy"
        case {"kind": "nothing"}:
            pigment, scatter = "rgbt 1", "diffuse 0"
        case {"kind": "conductor" | "rough_conductor"}:
            raise Unsupported("there are no metals of given n and k")
        case _:
            raise protocol.unknown("material", material)
    if medium["scattering_per_m"]:
        raise Unsupported("light that a medium scatters is not traced exactly")
    if absorption := medium["absorption_per_m"]:
        interior += f"media {{ absorption rgb {absorption:.17g} }} "
    sides = [
        f"{side} {{ pigment {{ {pigment} }} finish {{ ambient 0 {scatter} emission EXPOSURE*{radiance:.17g} }} }}"
        for side, radiance in (("texture", item["emitted_radiance"]), ("interior_texture", 0.0))
    ]
    return " ".join(sides) + (f" hollow interior {{ {interior}}}" if interior else "")


def body(item):
    """An object."""
    match item["shape"]:
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            return f"sphere {{ {vector(center)}, {radius:.17g} {finish(item)} {'inverse' if inward else ''} }}"
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            matrix = vector(np.ravel([*axes, center]))
            return f"box {{ <-1,-1,-1>, <1,1,1> {finish(item)} matrix {matrix} }}"
    corners, triangles = shapes.triangles(item["shape"])
    # POV-Ray's outer side is the one from which corners turn to the right, hence the order is turned round.
    faces = " ".join(f"triangle {{ {','.join(vector(corners[i]) for i in reversed(face))} }}" for face in triangles)
    return f"mesh {{ {faces} {finish(item)} }}"


def light(item):
    """A light without extent; a diffuse surface shows its colour, times cos θ, without a 1/π."""
    if item["kind"] == "sun":
        far = vector(-1e6 * np.array(item["direction"]))
        return f"light_source {{ {far}, rgb EXPOSURE*{item['irradiance'] / math.pi:.17g} parallel point_at <0,0,0> }}"
    cone = ""
    if item["kind"] == "spot":
        if item["dark_from_degrees"] > 90:
            raise Unsupported("spots wider than a half space are not traced")
        if item.get("falloff") not in (None, "smooth_in_cosine"):
            raise Unsupported("spots fall off by a smooth step in the cosine")
        cone = f"spotlight point_at {vector(item['target_m'])} radius {item['even_to_degrees']} falloff {item['dark_from_degrees']}"
    elif item["kind"] != "point":
        raise protocol.unknown("light", item)
    color = f"rgb EXPOSURE*{item['intensity'] / (2 * math.pi * FADE**2):.17g}"
    return f"light_source {{ {vector(item['position_m'])}, {color} fade_distance {FADE} fade_power 2 {cone} }}"


def camera(item, shift):
    """The camera, by its vectors to the right and up, which make it right-handed; shifted by fractions of the picture."""
    origin = np.array(item["origin_m"])
    right, up, forward = shapes.frame(item["target_m"] - origin, item["up"])
    match item["projection"]:
        case {"kind": "orthographic", "width_m": width}:
            kind = "orthographic"
            origin = origin + width * (shift[0] * right + shift[1] * up)
        case {"kind": "pinhole", "field_of_view_degrees": angle}:
            kind, width = "perspective", 2 * math.tan(math.radians(angle) / 2)
            forward = forward + width * (shift[0] * right + shift[1] * up)
        case other:
            raise Unsupported(f"there is no exact projection {other['kind']}")
    axes = f"direction {vector(forward)} right {vector(width * right)} up {vector(width * up)}"
    return f"camera {{ {kind} location {vector(origin)} {axes} }}"


def text(scene, mode, shift):
    """The scene in POV-Ray's language; all light is to be multiplied by EXPOSURE."""
    refuse_indirect(scene)
    limits = "max_trace_level 256 adc_bailout 1e-9" if mode == "measure" else ""
    parts = [f"#version 3.7; global_settings {{ assumed_gamma 1.0 {limits} }}", camera(scene["camera"], shift)]
    if sky := scene["sky"]:
        if sky["kind"] != "even":
            raise protocol.unknown("sky", sky)
        parts.append(f"background {{ rgb EXPOSURE*{sky['radiance']:.17g} }}")
    return "\n".join(parts + [body(item) for item in scene["objects"]] + [light(item) for item in scene["lights"]])


def trace(source, side, threads, exposure, folder):
    """Runs POV-Ray once; returns a linear picture of 16 bits, from 0 to 1."""
    (folder / "scene.pov").write_text(f"#declare EXPOSURE = {exposure:.17g};\n{source}", encoding="utf-8")
    options = ["+Iscene.pov", "+Oscene.ppm", "+FP16", "File_Gamma=1.0", f"+W{side}", f"+H{side}", f"+WT{threads}", "-A", "-D", "-V"]
    protocol.run("povray", *options, cwd=folder)
    raw = (folder / "scene.ppm").read_bytes()
    return np.frombuffer(raw[-6 * side * side :], ">u2").reshape(side, side, 3) / 65535


def render(scene, job):
    """Renders a scene and writes the picture. POV-Ray clips at 1, hence the light is lowered until nothing is, or raised."""
    pixels, grid = scene["pixels"], max(1, round(math.sqrt(job["samples"])))
    shift = (np.random.default_rng(job["seed"]).random(2) - 0.5) / (pixels * grid)
    source = text(scene, job["mode"], shift)
    exposure, brightest = 0.5, 0.0
    with tempfile.TemporaryDirectory() as folder:
        while not 0.25 < brightest < 1 and exposure < 1e9:
            exposure *= 1 if not brightest else 1 / 64 if brightest == 1 else 0.5 / brightest
            picture = trace(source, pixels * grid, job["threads"], exposure, Path(folder))
            brightest = max(picture.max(), 1e-5)  # below this nothing is resolved: look again with much more light
    protocol.write_picture(job["out"], picture.reshape(pixels, grid, pixels, grid, 3).mean((1, 3)) / exposure)


def version():
    """What POV-Ray says of itself."""
    run = subprocess.run(["povray", "--version"], capture_output=True, text=True)
    return "POV-Ray " + re.search(r"POV-Ray (\S+)", run.stdout + run.stderr).group(1)


if __name__ == "__main__":
    protocol.serve(version, render)
