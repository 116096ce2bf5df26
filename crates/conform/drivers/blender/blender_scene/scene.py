"""A scene as a whole.

Blender shows what a render would see (modifiers at the levels of renders, objects that are not hidden in renders) to engines
only, so the export is one: it "renders" by writing files.
"""

from pathlib import Path

import bpy
from mathutils import Vector

from . import camera, elements, lights, world
from .export import Export
from .meshes import SURFACES, Meshes

UNREAD = {"VOLUME": "volumes", "POINTCLOUD": "point clouds", "GREASEPENCIL": "strokes", "CURVES": "hair curves"}
VISIBLE = ("camera", "diffuse", "glossy", "transmission", "shadow")  # to which rays an object can be invisible
ALONE = dict(engine="ETALON_EXPORT", use_compositing=False, use_sequencer=False)  # nothing else may run


class Engine(bpy.types.RenderEngine):
    """The engine that writes what it should render; `folder` says where to, `result` what became of it."""

    bl_idname, bl_label = ALONE["engine"], "Export for Etalon"
    folder, layer, result = None, None, None

    def render(self, depsgraph):
        """Writes the scene as it is in the active view layer. Blender swallows what is raised here."""
        if depsgraph.view_layer.name != Engine.layer:
            return
        try:
            Engine.result = write(Path(Engine.folder), depsgraph)
        except Exception as fault:
            Engine.result = fault


def extent(depsgraph):
    """The middle of all meshes, and how far they reach from it."""
    corners = [instance.matrix_world @ Vector(corner)
               for instance in depsgraph.object_instances if instance.object.type in SURFACES
               for corner in instance.object.bound_box]
    if not corners:
        return Vector(), 1.0
    least, most = (Vector(pick(corner[axis] for corner in corners) for axis in range(3)) for pick in (min, max))
    return (least + most) / 2, max((most - least).length / 2, 1e-3)


def write(folder, depsgraph):
    """Writes all files; returns what was left out or comes out otherwise."""
    export = Export(folder, depsgraph.scene)
    eye = depsgraph.scene.camera
    bounds, meshes, lamps = extent(depsgraph), Meshes(export), []
    for instance in depsgraph.object_instances:
        thing = instance.object
        if not instance.show_self:
            continue
        if thing.type in SURFACES:
            meshes.add(instance)
            if thing.is_holdout or thing.is_shadow_catcher or not all(getattr(thing, f"visible_{ray}") for ray in VISIBLE):
                export.note(f"object {thing.name}", "all rays see it here")
        elif thing.type == "LIGHT":
            lamps.append((thing, instance.matrix_world.copy()))
        elif thing.type in UNREAD:
            export.note(f"object {thing.name}", f"{UNREAD[thing.type]} are left out")
        if instance.show_particles and any(one.settings.type == "HAIR" for one in thing.particle_systems):
            export.note(f"object {thing.name}", "hair of particles is left out")
    sky, bodies = world.element(export), meshes.elements()
    export.hides_lamps = sky is None and not meshes.shine and not any(lamp.visible_camera for lamp, _ in lamps)
    if depsgraph.scene.render.film_transparent and meshes.shine:
        export.note("scene", "where its film is transparent, surfaces that shine are not seen by the camera either")
    shining = [lights.element(export, lamp, matrix, bounds) for lamp, matrix in lamps]
    parts = [camera.integrator(export), camera.element(export, eye, eye.matrix_world), sky, *shining, *bodies]
    scene = elements.tree.Element("scene", {"version": "3.0.0"})
    scene.extend(part for part in parts if part is not None)
    elements.write(scene, folder / "scene.xml")
    return export.notes


def run(folder):
    """Exports the open scene into a folder, and returns the notes."""
    if bpy.context.scene.camera is None:
        raise ValueError("the scene has no camera")
    render = bpy.context.scene.render
    before = {name: getattr(render, name) for name in ALONE}
    bpy.utils.register_class(Engine)
    try:
        Engine.folder, Engine.layer, Engine.result = folder, bpy.context.view_layer.name, None
        for name, value in ALONE.items():
            setattr(render, name, value)
        bpy.ops.render.render()
    finally:
        for name, value in before.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(Engine)
    if Engine.result is None:
        raise ValueError("the active view layer is not one that is rendered")
    if isinstance(Engine.result, Exception):
        raise Engine.result
    return Engine.result
