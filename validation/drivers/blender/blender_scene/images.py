"""Images as files.

A picture of bytes goes out as it is; of floats, or as one channel, as numbers: PFM, or PGM of 16 bits. Blender's pixels are
rows from below, red, green, blue and alpha; those of bytes are encoded as their file says, those of floats are linear.
"""

import shutil
from pathlib import Path

import bpy
import numpy as np

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
    return export.once(("colours", image.name), lambda: write_colours(export, image))


def write_colours(export, image):
    """Writes it: floats as PFM, bytes as their own file if there is one that Etalon reads, else as PNG."""
    name = export.name(Path(image.name).stem)
    if image.is_float:
        return write_floats(export, name, pixels(image)[:, :, :3])
    source = Path(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else None
    keeps = image.source == "FILE" and not image.packed_file and not image.is_dirty
    if keeps and source and source.is_file() and source.suffix.lower() in (".png", ".jpg", ".jpeg"):
        path = f"textures/{name}{source.suffix.lower()}"
        shutil.copyfile(source, export.folder / path)
        return path
    path = f"textures/{name}.png"
    copy = image.copy()  # so that the image of the scene keeps its format and file
    copy.file_format = "PNG"
    copy.pixels.foreach_set(pixels(image).ravel())
    copy.save(filepath=str(export.folder / path))
    bpy.data.images.remove(copy)
    return path


def write_floats(export, name, values):
    """Writes rows from below as a portable float map, grey or in colour."""
    path = f"textures/{name}.pfm"
    kind = "Pf" if values.ndim == 2 else "PF"
    header = f"{kind}\n{values.shape[1]} {values.shape[0]}\n-1.0\n"  # -1 says little-endian
    (export.folder / path).write_bytes(header.encode() + values.astype("<f4").tobytes())
    return path


def channel(export, image, which):
    """The file of one linear channel: 0 to 3 for red, green, blue and alpha, or "luminance"."""
    return export.once(("channel", image.name, which), lambda: write_channel(export, image, which))


def write_channel(export, image, which):
    """Writes it."""
    values = pixels(image).astype(np.float64)
    if not image.is_float and not is_numbers(image):
        values[:, :, :3] = decoded(values[:, :, :3])
    grey = values[:, :, :3] @ LUMINANCE if which == "luminance" else values[:, :, which]
    name = export.name(f"{Path(image.name).stem}-{which if which == 'luminance' else 'rgba'[which]}")
    if image.is_float:
        return write_floats(export, name, grey)
    path = f"textures/{name}.pgm"
    whole = np.round(np.clip(grey, 0.0, 1.0)[::-1] * 65535).astype(">u2")
    header = f"P5\n{whole.shape[1]} {whole.shape[0]}\n65535\n"
    (export.folder / path).write_bytes(header.encode() + whole.tobytes())
    return path
