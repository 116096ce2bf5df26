"""Blender's scenes as files that Etalon reads; `blender_export.py` beside this folder starts it."""
