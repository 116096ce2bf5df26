"""The open scene, rendered by Cycles and, exported, by Etalon."""

import os
import subprocess

import blender_export
import bpy
import numpy as np

ETALON = os.environ.get("ETALON_BINARY")


def cycles(path, size, samples):
    """Renders by Cycles without anything that has a bias."""
    scene = bpy.context.scene
    scene.render.engine, settings = "CYCLES", scene.cycles
    settings.device, settings.samples, settings.seed = "CPU", samples, 1
    settings.use_denoising = settings.use_adaptive_sampling = False
    settings.sample_clamp_direct = settings.sample_clamp_indirect = settings.light_sampling_threshold = settings.blur_glossy = 0.0
    for kind in ("diffuse", "glossy", "transmission", "transparent_max"):
        setattr(settings, f"{kind}_bounces", settings.max_bounces)
    settings.pixel_filter_type, settings.filter_width = "BOX", 1.0
    render, image = scene.render, scene.render.image_settings
    render.resolution_x, render.resolution_y = (2 * side for side in size)
    render.resolution_percentage = 50
    render.filepath, render.threads_mode, render.threads = str(path), "FIXED", 1
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"  # linear, whatever the view transform
    bpy.ops.render.render(write_still=True)


def pixels(path):
    """The colours of a picture that Etalon can read."""
    subprocess.run([ETALON, "convert", path, path.with_suffix(".pfm")], check=True, capture_output=True)
    kind, size, _, data = path.with_suffix(".pfm").read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    assert kind == b"PF"
    return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1]


def both(folder, size=(64, 48), samples=256):
    """Both pictures, Cycles' first, and the notes of the export."""
    cycles(folder / "cycles.exr", size, samples)
    notes = blender_export.export(folder)
    command = [ETALON, "render", folder / "scene.xml", "-o", folder / "etalon.exr", "--threads", "1", "--seed", "1"]
    done = subprocess.run([*command, "--quiet"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return pixels(folder / "cycles.exr"), pixels(folder / "etalon.exr"), notes
