"""The scenes of the repository that have files, with all of their values and arrays set to what they are."""

from pathlib import Path

import etalon as et
import numpy as np
import pytest

SCENES = Path(__file__).parents[3] / "scenes"


def with_files():
    """Scenes that can be loaded as they are, and whose text names a file."""
    paths = sorted(path for path in SCENES.rglob("*") if path.suffix in (".xml", ".pbrt", ".gltf", ".glb"))
    texts = [(path, path.read_bytes()) for path in paths]
    is_whole = [b"<sensor" in text and (b"$resx" not in text or b'"resx"' in text) for _, text in texts]
    found = [p for (p, text), whole in zip(texts, is_whole) if p.suffix != ".xml" or whole and b'"filename"' in text]
    assert len(found) > 30
    return found


@pytest.mark.parametrize("path", with_files(), ids=lambda path: str(path.relative_to(SCENES)))
def test_a_scene_is_that_of_its_values(path):
    scene = et.load_file(path)
    values = scene.parameters(arrays=True)
    assert len(values) >= len(scene.parameters())
    pictures = [et.render(one, spp=1, seed=1, size=(16, 12)).numpy() for one in (scene, scene.with_parameters(values))]
    assert np.array_equal(*pictures, equal_nan=True)
