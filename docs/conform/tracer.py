"""A path tracer of numpy, as an example of a driver: diffuse quads and spheres, point lights, suns and even skies."""
import json
import sys

import numpy as np

SCENE, SAMPLES, SEED, OUT = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
EPSILON = 1e-6


def unsupported(why):
    print(why, file=sys.stderr)
    sys.exit(3)


def dot(a, b):
    return np.sum(a * b, axis=-1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def camera_rays(scene, random):
    """Origins and directions of SAMPLES rays through each pixel, row by row from the top."""
    camera, n = scene["camera"], scene["pixels"]
    origin, target, up = (np.array(camera[name]) for name in ("origin_m", "target_m", "up"))
    forward = unit(target - origin)
    right = unit(np.cross(forward, up))
    row, column = np.divmod(np.repeat(np.arange(n * n), SAMPLES), n)
    x = 2 * (column + random.random(len(row))) / n - 1
    y = 1 - 2 * (row + random.random(len(row))) / n
    across = x[:, None] * right + y[:, None] * np.cross(right, forward)
    projection = camera["projection"]
    if projection["kind"] == "orthographic":
        half = projection["width_m"] / 2
        return origin + half * across, np.broadcast_to(forward, across.shape)
    if projection["kind"] == "pinhole":
        half = np.tan(np.radians(projection["field_of_view_degrees"]) / 2)
        return np.broadcast_to(origin, across.shape), unit(forward + half * across)
    unsupported("it has no lenses")


def hit(shape, o, d):
    """Distances along rays, and normals of the outer side; infinity where nothing is hit."""
    center = np.array(shape["center_m"])
    if shape["kind"] == "quad":
        u, v = np.array(shape["half_u_m"]), np.array(shape["half_v_m"])
        n = unit(np.cross(u, v))
        with np.errstate(divide="ignore", invalid="ignore"):
            t = dot(center - o, n) / dot(d, n)
            p = o + t[:, None] * d - center
            inside = (np.abs(dot(p, u)) <= dot(u, u)) & (np.abs(dot(p, v)) <= dot(v, v))
        return np.where(inside & (t > EPSILON), t, np.inf), np.broadcast_to(n, o.shape)
    b, c = dot(o - center, d), dot(o - center, o - center) - shape["radius_m"] ** 2
    root = np.sqrt(np.maximum(b * b - c, 0))
    near, far = -b - root, -b + root
    t = np.where(near > EPSILON, near, far)
    t = np.where((b * b > c) & (t > EPSILON), t, np.inf)
    sign = -1 if shape["inward"] else 1
    with np.errstate(invalid="ignore"):
        return t, sign * (o + t[:, None] * d - center) / shape["radius_m"]


def nearest(scene, o, d):
    """The nearest hits: distances, normals, and indices of objects."""
    t, n = np.full(len(o), np.inf), np.zeros(o.shape)
    which = np.full(len(o), -1)
    for index, thing in enumerate(scene["objects"]):
        own, normal = hit(thing["shape"], o, d)
        closer = own < t
        t, which, n = np.where(closer, own, t), np.where(closer, index, which), np.where(closer[:, None], normal, n)
    return t, n, which


def lit(scene, p, n):
    """Irradiance from lights without extent, on the side of n."""
    total = np.zeros(len(p))
    for light in scene["lights"]:
        if light["kind"] == "point":
            toward = np.array(light["position_m"]) - p
            distance = np.linalg.norm(toward, axis=-1)
            strength = light["intensity"] / distance**2
        elif light["kind"] == "sun":
            toward = np.broadcast_to(-np.array(light["direction"]), p.shape)
            distance, strength = np.full(len(p), np.inf), light["irradiance"]
        else:
            unsupported(f"it has no {light['kind']} lights")
        toward = unit(toward)
        free = nearest(scene, p + EPSILON * n, toward)[0] >= distance
        total += np.where(free, strength * np.maximum(dot(n, toward), 0), 0)
    return total


def radiance(scene, o, d, random):
    """What is seen along each ray: paths that end at random."""
    seen, beta = np.zeros(len(o)), np.ones(len(o))
    alive = np.arange(len(o))
    sky = (scene["sky"] or {"radiance": 0})["radiance"]
    glow = np.array([thing["emitted_radiance"] for thing in scene["objects"]])
    albedo = np.array([thing["material"]["reflectance"] for thing in scene["objects"]])
    while len(alive):
        t, n, which = nearest(scene, o, d)
        seen[alive[which < 0]] += beta[which < 0] * sky
        found = which >= 0
        o, d, t, n, which, beta, alive = (x[found] for x in (o, d, t, n, which, beta, alive))
        seen[alive] += beta * np.where(dot(n, d) < 0, glow[which], 0)
        n = np.where((dot(n, d) > 0)[:, None], -n, n)
        o = o + t[:, None] * d
        seen[alive] += beta * albedo[which] / np.pi * lit(scene, o, n)
        # A path goes on with the probability of being reflected, so that its weight stays the same.
        go = random.random(len(alive)) < albedo[which]
        o, n, beta, alive = (x[go] for x in (o, n, beta, alive))
        d = unit(n + unit(random.normal(size=n.shape)))
        o = o + EPSILON * n
    return seen


def main():
    scene = json.load(open(SCENE))
    for thing in scene["objects"]:
        if thing["material"]["kind"] != "diffuse" or thing["shape"]["kind"] not in ("quad", "sphere"):
            unsupported("it has diffuse quads and spheres only")
    if scene["sky"] and scene["sky"]["kind"] != "even":
        unsupported("it has even skies only")
    random, n = np.random.default_rng(SEED), scene["pixels"]
    picture = radiance(scene, *camera_rays(scene, random), random).reshape(n, n, SAMPLES).mean(2)
    with open(OUT, "wb") as file:  # PFM has the bottom row first; -1 says little-endian.
        file.write(f"Pf\n{n} {n}\n-1.0\n".encode())
        picture[::-1].astype("<f4").tofile(file)


main()
