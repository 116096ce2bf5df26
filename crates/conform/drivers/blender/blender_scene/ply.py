"""Meshes as binary PLY files."""

import numpy as np


def shared(corners):
    """The different rows of an array of corners, and for each corner which of them it is."""
    corners = np.ascontiguousarray(corners, dtype="<f4") + np.float32(0.0)  # −0 becomes 0
    whole = corners.view(np.dtype((np.void, corners.dtype.itemsize * corners.shape[1]))).ravel()
    _, first, number = np.unique(whole, return_index=True, return_inverse=True)
    return corners[first], number.reshape(-1)


def write(path, positions, normals, coordinates, colours=None):
    """Writes triangles, of which each has three rows in every array: places, normals, texture coordinates (or None), and
    colours by name. Equal corners become one vertex."""
    columns, names = [positions, normals], ["x", "y", "z", "nx", "ny", "nz"]
    if coordinates is not None:
        columns.append(coordinates)
        names += ["u", "v"]
    for name, colour in (colours or {}).items():
        columns.append(colour)
        names += [f"{name}_{channel}" for channel in "rgb"]
    vertices, corners = shared(np.concatenate(columns, axis=1))
    faces = np.empty(len(corners) // 3, dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, corners.reshape(-1, 3)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode() + vertices.tobytes() + faces.tobytes())
