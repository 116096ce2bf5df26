"""Writes timed_sunsky_values.txt: radiances of Mitsuba 3.9.1's `timed_sunsky` (variant llvm_ad_spectral; the scalar
variants see the sun in every direction; without `complex_sun` all see it as if it stood lower).

    python timed_sunsky_values.py > timed_sunsky_values.txt

A line: the place and the calendar, as `CALENDAR` names them, and what share of the shutter interval is over ; direction ;
radiance at 330, 450, 555 and 690 nm.
"""
import mitsuba as mi

mi.set_variant("llvm_ad_spectral")
import drjit as dr
import numpy as np

LAMBDA = [330.0, 450.0, 555.0, 690.0]
CALENDAR = (
    "latitude longitude timezone start_year start_month start_day end_year end_month end_day "
    "window_start_time window_end_time shutter_open shutter_close"
).split()
WHOLE = {name for name in CALENDAR if name.startswith(("start", "end"))}


def show(values):
    return " ".join(f"{float(v):.8g}" for v in np.array(values).ravel())


for calendar in [
    [35.6894, 139.6917, 9, 2025, 1, 1, 2026, 1, 1, 7, 19, 0, 1],
    [52.52, 13.405, 1, 2025, 6, 20, 2025, 6, 24, 5, 20, 0, 1],
    [-33.87, 151.21, 10, 2024, 2, 27, 2024, 3, 2, 8, 16, 2, 4],
    [10, 0, 0, 2025, 3, 20, 2025, 3, 20, 6.5, 18, 0, 1],
]:
    light = mi.load_dict(
        {
            "type": "timed_sunsky",
            "sun_aperture": 4.0,
            "complex_sun": True,
            **{n: int(v) if n in WHOLE else float(v) for n, v in zip(CALENDAR, calendar)},
        }
    )
    for share in (0.02, 0.13, 0.37, 0.51, 0.77, 0.96):
        time = calendar[-2] + share * (calendar[-1] - calendar[-2])
        at = dr.zeros(mi.Interaction3f)
        at.time = time
        # Chosen by the sun near its centre, and twice by the sky.
        for u in ([0.5, 0.5], [0.003, 0.3], [0.0005, 0.7]):
            direction = np.array(light.sample_direction(at, mi.Point2f(*u))[0].d).ravel()
            si = dr.zeros(mi.SurfaceInteraction3f)
            si.wi = mi.Vector3f([-float(x) for x in direction])
            si.wavelengths, si.time = LAMBDA, time
            print(f"{show([*calendar, share])} ; {show(direction)} ; {show(light.eval(si))}")
