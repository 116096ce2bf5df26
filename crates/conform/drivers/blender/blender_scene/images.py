"""Images of Blender as files.

A picture of bytes goes out as its own file, or as PNG; one of floats as PFM; one channel as PGM of 16 bits, or as PFM. Blender's
pixels are rows from below, red, green, blue and alpha; those of bytes are encoded as their file says, those of floats are linear.
"""

import shutil
from pathlib import Path

import bpy
import numpy as np

from . import pictures

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear Rec. 709


def pixels(image):
    """All pixels, as rows from below."""
    width, height = image.size
    values = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)


def is_numbers(image):
    """Whether bytes are values as they are, and not encoded as sRGB."""
    return image.colorspace_settings.name in ("Non-Color", "Raw", "Linear Rec.709")


def decoded(values):
    """The linear values of sRGB's (IEC 61966-2-1)."""
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.04045) + 0.055) / 1.055) ** 2.4)


def check(export, image, where):
    """Whether there is a picture; says what of it cannot be kept."""
    if image is None:
        export.note(where, "there is no image; Blender shows it as magenta, here it is black")
        return False
    if not image.has_data and not (image.size[0] and image.size[1]):
        export.note(where, f"the image {image.name} cannot be read; here it is black")
        return False
    if image.source not in ("FILE", "GENERATED"):
        export.note(where, f"of the image {image.name} ({image.source.lower()}) one picture is used")
    if not is_numbers(image) and image.colorspace_settings.name != "sRGB" and not image.is_float:
        export.note(where, f"the colour space {image.colorspace_settings.name} is read as sRGB")
    return True


def colours(export, image):
    """The file of a picture in colour, from the folder of the scene."""
    return export.once(("colours", image.name_full), lambda: write_colours(export, image))


def write_colours(export, image):
    """Writes it."""
    source = Path(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else None
    kept = image.source == "FILE" and not image.packed_file and not image.is_dirty and not image.is_float
    if kept and source and source.is_file() and source.suffix.lower() in (".png", ".jpg", ".jpeg"):
        path = f"textures/{export.name(source.stem)}{source.suffix.lower()}"
        shutil.copyfile(source, export.folder / path)
        return path
    return write(export, image, Path(image.name).stem, pixels(image)[:, :, :3])


def channel(export, image, which):
    """The file of one linear channel: 0 to 3 for red, green, blue and alpha, or "luminance"."""
    return export.once(("channel", image.name_full, which), lambda: write_channel(export, image, which))


def write_channel(export, image, which):
    """Writes it."""
    values = pixels(image).astype(np.float64)
    if not image.is_float and not is_numbers(image):
        values[:, :, :3] = decoded(values[:, :, :3])
    grey = values[:, :, :3] @ LUMINANCE if which == "luminance" else values[:, :, which]
    return write(export, image, f"{Path(image.name).stem}-{which if which == 'luminance' else 'rgba'[which]}", grey)


def write(export, image, name, values):
    """Writes values in the format that keeps them."""
    if image.is_float:
        path, contents = f"textures/{export.name(name)}.pfm", pictures.pfm(values)
    elif values.ndim == 2:
        path, contents = f"textures/{export.name(name)}.pgm", pictures.pgm(values)
    else:
        path, contents = f"textures/{export.name(name)}.png", pictures.png(values)
    (export.folder / path).write_bytes(contents)
    return path
