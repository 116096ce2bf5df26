"""Meshes: what Blender's modifiers make of an object, as one PLY file for each of its materials."""

import numpy as np

from . import ply, shaders, surface
from .elements import plugin, reference, string, transform
from .textures import attribute

SURFACES = ("MESH", "CURVE", "SURFACE", "META", "FONT")


def read(collection, name, kind, columns):
    """A property of all items of a collection, as rows."""
    values = np.empty(len(collection) * columns, dtype=kind)
    collection.foreach_get(name, values)
    return values.reshape(len(collection), columns) if columns > 1 else values


def corners_of_triangles(mesh):
    """For each corner of the triangles: the number of its vertex and of its corner in the mesh; for each triangle the number
    of its material slot."""
    mesh.calc_loop_triangles()
    triangles = mesh.loop_triangles
    vertices = read(triangles, "vertices", np.int32, 3).ravel()
    loops = read(triangles, "loops", np.int32, 3).ravel()
    return vertices, loops, read(triangles, "material_index", np.int32, 1)


def coordinates(mesh, layer):
    """The texture coordinates of all corners, v from above; None if there are none of this name."""
    layers = mesh.uv_layers
    found = layers.get(layer) if layer else next((one for one in layers if one.active_render), None)
    if found is None:
        return None
    return read(found.uv, "vector", np.float32, 2) * [1, -1] + [0, 1]


def colours(export, mesh, names, vertices, loops):
    """The colours of the corners of triangles, by the names of the attributes."""
    result = {}
    for name in names:
        found = mesh.color_attributes.get(name) if name else mesh.color_attributes.active_color
        if found is None or found.domain not in ("POINT", "CORNER"):
            export.note(f"mesh {mesh.name}", f"there are no colours of the name {name!r}")
            values = np.zeros((len(loops), 3), dtype=np.float32)
        else:
            values = read(found.data, "color", np.float32, 4)[vertices if found.domain == "POINT" else loops, :3]
        result[attribute(name)] = values
    return result


def files(export, thing, mesh):
    """Writes the parts of a mesh, and returns their materials with the names of the files."""
    vertices, loops, slots = corners_of_triangles(mesh)
    places = read(mesh.vertices, "co", np.float32, 3)[vertices]
    normals = read(mesh.corner_normals, "vector", np.float32, 3)[loops]
    parts = []
    for slot in np.unique(slots):
        data = thing.material_slots[slot].material if slot < len(thing.material_slots) else None
        look, textures = shaders.material(export, data)
        if surface.is_invisible(look):
            continue
        here = np.repeat(slots == slot, 3)
        uv = coordinates(mesh, textures.layer or "")
        if uv is None and textures.layer is not None:
            export.note(f"object {thing.name}", f"it has no texture coordinates {textures.layer!r}".replace(" ''", ""))
        painted = colours(export, mesh, textures.attributes, vertices[here], loops[here])
        path = f"meshes/{export.name(thing.name)}.ply"
        ply.write(export.folder / path, places[here], normals[here], None if uv is None else uv[loops[here]], painted)
        parts.append((data, path))
    return parts


class Meshes:
    """The meshes of a scene. An object that stands in several places is written once."""

    def __init__(self, export):
        self.export = export
        self.parts, self.places = {}, {}
        self.shine = False  # whether any of them does

    def add(self, instance):
        """Takes a mesh in one of its places."""
        thing = instance.object
        if abs(instance.matrix_world.determinant()) < 1e-30:
            self.export.note(f"object {thing.name}", "its scale makes it flat, which is left out")
            return
        key = (thing.data.as_pointer() if thing.type == "MESH" else thing.original.name_full, *self.materials(thing))
        if key not in self.parts:
            mesh = thing.to_mesh()
            self.parts[key] = files(self.export, thing, mesh) if mesh and len(mesh.polygons) else []
            thing.to_mesh_clear()
        self.places.setdefault(key, []).append((thing.name, instance.matrix_world.copy()))

    def materials(self, thing):
        """The names of an object's materials."""
        return tuple(slot.material.name_full if slot.material else None for slot in thing.material_slots)

    def elements(self):
        """Materials, shapes, groups and instances."""
        used, shapes = {}, []
        for key, parts in self.parts.items():
            places = self.places[key]
            for data, _ in parts:
                self.material(data, used)
            shining = any(surface.emitter(shaders.material(self.export, data)[0]) is not None for data, _ in parts)
            self.shine |= shining
            if len(places) == 1 or shining:  # what shines cannot be an instance
                for _, matrix in places:
                    shapes += [self.shape(data, path, used, matrix) for data, path in parts]
            elif parts:
                group = self.export.name(f"{places[0][0]}-group")
                shapes.append(plugin("shape", "shapegroup", *(self.shape(data, path, used) for data, path in parts), id=group))
                shapes += [plugin("shape", "instance", reference(group), transform("to_world", matrix)) for _, matrix in places]
        return [*(bsdf for _, bsdf in used.values()), *shapes]

    def material(self, data, used):
        """Makes a material one of those that are used."""
        key = data.name_full if data else None
        if key not in used:
            look = shaders.material(self.export, data)[0]
            name = self.export.name(data.name if data else "no material")
            bsdf = surface.material(look)
            bsdf.set("id", name)
            used[key] = (name, bsdf)

    def shape(self, data, path, used, matrix=None):
        """A part of a mesh."""
        look = shaders.material(self.export, data)[0]
        return plugin(
            "shape",
            "ply",
            string("filename", path),
            None if matrix is None else transform("to_world", matrix),
            reference(used[data.name_full if data else None][0]),
            surface.emitter(look),
        )
