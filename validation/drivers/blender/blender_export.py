"""Writes a scene of Blender as files that Etalon reads: OUT/scene.xml, OUT/meshes, OUT/textures.

    blender --background FILE.blend --python blender_export.py -- OUT
    python blender_export.py FILE.blend OUT          # with the module `bpy` of PyPI
    import blender_export; blender_export.export(out)    # of the scene that is open

docs/blender.md says what is understood. The parts stand in the folder `blender_scene` beside this file.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))


def export(out):
    """Exports the open scene into a folder; returns what was left out or comes out otherwise, which is also printed."""
    from blender_scene import scene

    return scene.run(Path(out))


def main():
    """The command line, of Blender or of Python."""
    import bpy

    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    if not bpy.app.background or len(arguments) == 2:
        bpy.ops.wm.open_mainfile(filepath=arguments.pop(0))
    if len(arguments) != 1:
        sys.exit("usage: blender --background FILE.blend --python blender_export.py -- OUT\n"
                 "   or: python blender_export.py FILE.blend OUT")
    export(arguments[0])


if __name__ == "__main__":
    main()
