"""Files of arrays, written by hand."""

import struct
import zlib

import numpy as np


def write_png(path, array):
    """A PNG file by the standard library alone: rows of unfiltered bytes."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, channels = array.shape
    rows = b"".join(b"\0" + row.tobytes() for row in array)
    colour = {1: 0, 3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    )


def write_pfm(path, array):
    """A file of floats, bottom row first."""
    height, width, channels = array.shape
    kind = {1: "Pf", 3: "PF"}[channels]
    path.write_bytes(f"{kind}\n{width} {height}\n-1.0\n".encode() + array[::-1].astype("<f4").tobytes())


def write_vol(path, array):
    z, y, x, channels = array.shape
    header = b"VOL\x03" + np.array([1, x, y, z, channels], "<i4").tobytes()
    path.write_bytes(header + np.array([0, 0, 0, 1, 1, 1], "<f4").tobytes() + array.astype("<f4").tobytes())


def write_serialized(path, meshes):
    """Meshes of vertices and faces, one after the other, as Mitsuba writes them (version 4, floats)."""
    contents, starts = b"", []
    for vertices, faces in meshes:
        starts.append(len(contents))
        counts = struct.pack("<I", 0x1000) + b"\0" + struct.pack("<QQ", len(vertices), len(faces))
        body = counts + np.asarray(vertices, "<f4").tobytes() + np.asarray(faces, "<u4").tobytes()
        contents += struct.pack("<HH", 0x041C, 4) + zlib.compress(body)
    path.write_bytes(contents + struct.pack(f"<{len(starts)}QI", *starts, len(starts)))
