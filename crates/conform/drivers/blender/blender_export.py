"""Writes a scene of Blender as files that Etalon reads: OUT/scene.xml, OUT/meshes, OUT/textures.

    blender --background FILE.blend --python blender_export.py -- OUT
    python blender_export.py FILE.blend OUT              # with the module `bpy` of PyPI
    import blender_export; blender_export.export(OUT)    # of the scene that is open

docs/blender.md says what is understood. The parts stand in the folder `blender_scene` beside this file, which is a folder of its
own so that Blender does not take the driver `cycles.py` for its add-on of that name.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

USAGE = """usage: blender --background FILE.blend --python blender_export.py -- OUT
   or: python blender_export.py FILE.blend OUT"""


def export(out):
    """Exports the open scene into a folder; returns what was left out or comes out otherwise, which is also printed."""
    from blender_scene import scene

    return scene.run(Path(out))


def main(arguments):
    """The command line, of Blender (whose file is open) or of Python."""
    in_blender = "--" in arguments
    rest = arguments[arguments.index("--") + 1 :] if in_blender else arguments[1:]
    if len(rest) != (1 if in_blender else 2):
        sys.exit(USAGE)
    if not in_blender:
        import bpy

        bpy.ops.wm.open_mainfile(filepath=rest[0])
    export(rest[-1])


if __name__ == "__main__":
    main(sys.argv)
