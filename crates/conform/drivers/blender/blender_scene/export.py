"""What the parts of an export share: the folder it goes to, what has been said, and what is written once."""

import re
import sys


class Export:
    """An export that is under way."""

    def __init__(self, folder, scene):
        self.folder, self.scene = folder, scene
        self.notes = []
        self.written = {}  # files and materials, by what they are of
        self.names = set()
        self.hides_lamps = False  # whether the camera sees through all that shines
        for part in ("meshes", "textures"):
            (folder / part).mkdir(parents=True, exist_ok=True)

    def note(self, where, what):
        """Says, once, what is left out or comes out otherwise."""
        said = f"{where}: {what}"
        if said not in self.notes:
            self.notes.append(said)
            print(f"note: {said}", file=sys.stderr)

    def name(self, wish):
        """A name for a file or an id that is not taken, near the one of Blender."""
        plain = re.sub(r"[^A-Za-z0-9_-]+", "_", wish) or "unnamed"
        name, number = plain, 2
        while name.lower() in self.names:  # some file systems do not tell capitals from small letters
            name, number = f"{plain}-{number}", number + 1
        self.names.add(name.lower())
        return name

    def once(self, key, make):
        """What `make` returned the first time that this key was asked for."""
        if key not in self.written:
            self.written[key] = make()
        return self.written[key]
