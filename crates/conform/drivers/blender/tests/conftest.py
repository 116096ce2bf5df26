"""Finds the modules that are tested. The folder above theirs must not be searched: see `blender_export.py`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
