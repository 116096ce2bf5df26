"""Pictures as the bytes of files. Rows come from below, as Blender has them."""

import struct
import zlib

import numpy as np


def pfm(values):
    """Floats, grey or in colour, as a portable float map; its rows come from below, too, and −1 says little-endian."""
    kind = "Pf" if values.ndim == 2 else "PF"
    header = f"{kind}\n{values.shape[1]} {values.shape[0]}\n-1.0\n"
    return header.encode() + values.astype("<f4").tobytes()


def whole(values, most):
    """Numbers from 0 to 1 as whole ones, rows from the top."""
    return np.round(np.clip(values[::-1], 0.0, 1.0) * most)


def pgm(values):
    """Grey numbers from 0 to 1 in 16 bits."""
    header = f"P5\n{values.shape[1]} {values.shape[0]}\n65535\n"
    return header.encode() + whole(values, 65535).astype(">u2").tobytes()


def png(values):
    """Colours from 0 to 1, already encoded, in 8 bits."""
    height, width = values.shape[:2]
    rows = np.zeros((height, 1 + 3 * width), dtype=np.uint8)  # each row begins with its filter: none
    rows[:, 1:] = whole(values, 255).reshape(height, 3 * width)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(map(chunk, parts))


def chunk(part):
    """A part of a PNG file: its length, kind, contents and checksum."""
    kind, contents = part
    return struct.pack(">I", len(contents)) + kind + contents + struct.pack(">I", zlib.crc32(kind + contents))
