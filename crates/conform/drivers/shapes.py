"""What several drivers need of a scene's objects: corners and faces, which turn to the left from outside, and frames of axes.

Import this before `protocol`, which takes the drivers' folder off the search path.
"""

import functools
import itertools
import math

import numpy as np
import protocol

BLACK = {"kind": "diffuse", "reflectance": 0.0}


def polygons(shape):
    """Corners and faces of a shape."""
    match shape:
        case {"kind": "quad", "center_m": center, "half_u_m": u, "half_v_m": v}:
            return np.add(center, np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ [u, v]), [(0, 1, 2, 3)]
        case {"kind": "box", "center_m": center, "half_axes_m": axes}:
            signs = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)])
            faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
            return np.add(center, signs @ axes), faces
        case {"kind": "mesh", "positions_m": positions, "triangles": faces}:
            return np.array(positions), faces
        case {"kind": "sphere", "center_m": center, "radius_m": radius, "inward": inward}:
            corners, faces = ball()
            return center + radius * corners, (faces[:, ::-1] if inward else faces).tolist()
    raise protocol.unknown("shape", shape)


def triangles(shape):
    """Corners and faces of a shape, each face divided into triangles about its first corner."""
    corners, faces = polygons(shape)
    return corners, [(face[0], *edge) for face in faces for edge in zip(face[1:], face[2:])]


@functools.cache
def ball():
    """20,480 triangles, an icosahedron's divided five times, with the area of the unit sphere."""
    golden = (1 + math.sqrt(5)) / 2
    corners = unit(np.array([np.roll((0, a, b * golden), turn) for turn in range(3) for a in (-1, 1) for b in (-1, 1)]))
    triples = (triple for triple in itertools.permutations(range(12), 3) if triple[0] == min(triple))
    faces = np.array([triple for triple in triples if is_face(corners[[*triple]])])
    for _ in range(5):
        edges = np.sort(faces[:, [(0, 1), (1, 2), (2, 0)]]).reshape(-1, 2)
        edges, middles = np.unique(edges, axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = faces.T, len(corners) + middles.reshape(-1, 3).T
        faces = np.concatenate([np.stack(face, 1) for face in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        corners = np.concatenate([corners, unit(corners[edges].sum(1))])
    a, b, c = corners[faces].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return corners * math.sqrt(4 * math.pi / area), faces


def is_face(triple):
    """Whether three corners of an icosahedron in the unit sphere, whose edges are 1.05, are those of a face, in its order."""
    return np.linalg.det(triple) > 0 and all(math.dist(p, q) < 1.1 for p, q in itertools.combinations(triple, 2))


def unit(vectors):
    """Vectors of the length 1."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def frame(forward, up=None):
    """Right, up and forward, of the length 1, for who looks forward; without `up`, the turn about that axis is of no matter."""
    forward = unit(np.array(forward))
    right = unit(np.cross(forward, np.eye(3)[np.argmin(np.abs(forward))] if up is None else up))
    return right, np.cross(right, forward), forward


def placed(axes, origin):
    """The matrix of 4 × 4 whose columns are these three axes, then the origin."""
    return np.vstack([np.column_stack([*axes, origin]), [0, 0, 0, 1]])


def is_diffuse(item):
    """Whether the surface of an object scatters light in all directions."""
    return item["material"]["kind"] == "diffuse" and item["material"]["reflectance"] > 0


def is_lamp(item):
    """Whether an object is what sphere lamps are: a black ball that shines outward."""
    shape = item["shape"]
    return shape["kind"] == "sphere" and not shape["inward"] and item["material"] == BLACK and item["emitted_radiance"] > 0


def core(item, eye):
    """What blocks light in place of a ball whose lamp does not: a black one just beneath its surface, or nothing if it looks so
    small that it blocks next to nothing (and single precision could not tell the two surfaces apart)."""
    shape = item["shape"]
    if shape["radius_m"] > 0.01 * math.dist(shape["center_m"], eye):
        return [{**item, "shape": {**shape, "radius_m": 0.999 * shape["radius_m"]}, "emitted_radiance": 0}]
    return []
