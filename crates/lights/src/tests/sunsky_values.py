"""Writes sunsky_values.txt: radiances of Mitsuba 3.9.1's `sunsky` (variant scalar_spectral).

    python sunsky_values.py > sunsky_values.txt

A line: turbidity, albedo, complex_sun, sun_aperture ; direction to the sun ; direction ; radiance at 330, 450, 555 and
690 nm. A line `moment`: latitude, longitude, timezone, year, month, day, hour, minute, second ; direction ; the sky's
radiance there.
"""
import math
import random

import mitsuba as mi

mi.set_variant("scalar_spectral")
import drjit as dr
import numpy as np

LAMBDA = [330.0, 450.0, 555.0, 690.0]


def unit(v):
    v = np.array(v, dtype=float)
    v = v / np.linalg.norm(v)
    return [float(np.float32(x)) for x in v]


def show(values):
    return " ".join(f"{float(v):.8g}" for v in values)


def radiance(light, direction):
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f([-x for x in direction])
    si.wavelengths = LAMBDA
    return light.eval(si)


random.seed(3)
for turbidity, albedo, complex_sun, aperture in [
    (1.0, 0.0, False, 0.5358),
    (3.0, 0.3, True, 0.5358),
    (4.6, 0.9, False, 5.0),
    (10.0, 0.5, True, 2.0),
]:
    for theta in (5, 50, 85, 89.9):
        t, p = math.radians(theta), random.uniform(0, 2 * math.pi)
        sun = unit([math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)])
        light = mi.load_dict(
            {
                "type": "sunsky",
                "turbidity": turbidity,
                "albedo": albedo,
                "complex_sun": complex_sun,
                "sun_aperture": aperture,
                "sun_direction": sun,
            }
        )
        half = math.radians(0.5 * aperture)
        for i in range(5):
            if i < 2:
                # In the sun, above its centre where that is low.
                direction = unit([sun[0], sun[1], sun[2] + 0.6 * i * half])
            else:
                direction = unit([random.gauss(0, 1), random.gauss(0, 1), abs(random.gauss(0, 1))])
            print(f"{turbidity} {albedo} {int(complex_sun)} {aperture} ; {show(sun)} ; {show(direction)} ; {show(radiance(light, direction))}")
NAMES = ["latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"]
for moment in [
    [35.6894, 139.6917, 9, 2010, 7, 10, 15, 0, 0],
    [52.52, 13.405, 1, 2026, 12, 21, 12, 30, 15],
    [-33.87, 151.21, 10, 2003, 2, 28, 8, 45, 0],
    [0, 0, 0, 1999, 3, 20, 17, 0, 0],
    [64.1, -21.9, 0, 2012, 6, 21, 4, 20, 0],
]:
    ints = {"year", "month", "day"}
    light = mi.load_dict(
        {"type": "sunsky", "sun_scale": 0.0, **{n: int(v) if n in ints else float(v) for n, v in zip(NAMES, moment)}}
    )
    for direction in (unit([1, 0, 0.5]), unit([-0.3, 1, 0.2]), unit([0, -1, 0.8])):
        print(f"moment {' '.join(str(v) for v in moment)} ; {show(direction)} ; {show(radiance(light, direction))}")
