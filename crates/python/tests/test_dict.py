"""Scenes as dicts: each gives the picture of its XML."""

import copy
import re
from pathlib import Path

import etalon as et
import numpy as np
import pytest
from dict_scenes import PAIRS, T, ball, pixels, scene, scene_xml, with_bsdf

ROOT = Path(__file__).resolve().parents[3]
PICTURES = {}


@pytest.mark.parametrize("name", PAIRS)
def test_dicts_are_their_xml(name):
    parts, xml = PAIRS[name]
    loaded, read = et.load_dict(scene(**parts)), et.load_string(scene_xml(**xml))
    PICTURES[name] = pixels(loaded)
    assert np.array_equal(PICTURES[name], pixels(read))
    assert (loaded.integrator, loaded.size, len(loaded.notes)) == (read.integrator, read.size, len(read.notes))
    # The text is the same scene again, and so is another integrator's picture.
    again = et.load_string(et.dict_to_xml(scene(**parts)))
    assert np.array_equal(PICTURES[name], pixels(again))


def test_all_pairs_differ():
    # Otherwise what they say would not matter to the pictures.
    if len(PICTURES) < len(PAIRS):
        pytest.skip("needs all pictures")
    assert len(PAIRS) >= 30
    assert len({picture.tobytes() for picture in PICTURES.values()}) == len(PAIRS)


def test_every_plugin_is_known_by_its_name():
    words = (ROOT / "docs/plugins.toml").read_text()
    found = re.findall(r'^class = "(\w+)"\nnames = \[(.*)\]', words, re.MULTILINE)
    plugins = [(kind, name) for kind, names in found for name in re.findall(r'"(\w+)"', names)]
    assert len(plugins) > 150
    for kind, name in plugins:
        # Two are of two classes; a grid of space may be any texture.
        kind = {("volume", "expression"): "texture", ("shape", "hair"): "bsdf"}.get((kind, name), kind)
        assert f'<{kind} type="{name}" name="x" id="x"/>' in et.dict_to_xml({"type": "scene", "x": {"type": name}})
    strands = {"type": "scene", "x": {"type": "hair", "filename": Path("a.txt")}}
    assert '<shape type="hair"' in et.dict_to_xml(strands) and 'value="a.txt"' in et.dict_to_xml(strands)


def test_options_render_a_dict_again():
    loaded = et.load_dict(scene())
    assert "<dict>, 8 × 6, path" in repr(loaded)
    other = et.render(loaded, spp=4, seed=1, integrator="direct", size=(6, 5))
    direct = et.load_string(scene_xml(integrator='<integrator type="direct"/>'))
    same = et.render(direct, spp=4, seed=1, size=(6, 5))
    with pytest.raises(et.SceneError, match=r"^sensor: error: `forward` waits for"):
        et.render(loaded, integrator="forward")
    assert other.size == (6, 5) and np.array_equal(other.numpy(), same.numpy())


def test_notes_have_key_paths():
    bright = np.full((2, 2, 3), 1.5, np.float32)
    notes = et.load_dict(with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": bright})).notes
    assert len(notes) == 1 and notes[0].startswith("ball.bsdf.reflectance.data: note: ")


def test_dicts_can_be_copied_and_are_left_alone():
    given = scene(ball=ball(bsdf={"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.1, 0.2, 0.3]}}))
    before = copy.deepcopy(given)
    assert before["floor"]["to_world"] is not given["floor"]["to_world"]
    et.load_dict(given)
    assert given == before


def test_transforms():
    turned = T().translate([1, 2, 3]).rotate([0, 0, 2], 90).scale([2, 1, 1]).matrix
    assert turned @ [1, 0, 0, 1] == pytest.approx([1, 4, 3, 1])
    assert (T().translate([1, 2, 3]) @ T().rotate((0, 0, 1), 90)).matrix @ [1, 0, 0, 1] == pytest.approx([1, 3, 3, 1])
    assert T(turned).inverse().matrix @ turned == pytest.approx(np.eye(4))
    assert T().scale(3).matrix == pytest.approx(np.diag([3, 3, 3, 1]))
    frame = T().look_at(origin=[0, 0, 5], target=[0, 0, 0], up=[0, 1, 0]).matrix
    assert frame @ [0, 1, 1, 1] == pytest.approx([0, 1, 4, 1])
    assert eval(repr(T().scale(2)), {"etalon": et}).matrix == pytest.approx(np.diag([2, 2, 2, 1]))
    assert T().matrix.dtype == np.float64
    for wrong in [
        lambda: T(np.eye(3)),
        lambda: T().translate([1, 2]),
        lambda: T().rotate([0, 0, 0], 3),
        lambda: T().look_at([0, 0, 0], [0, 0, 0]),
        lambda: T().scale([1, 1, 0]).inverse(),
    ]:
        with pytest.raises(ValueError):
            wrong()


class Mitsubas:
    """As Mitsuba's transforms are: an object with a matrix."""

    def __init__(self, matrix):
        self.matrix = matrix


class Color3f(list):
    """As Mitsuba's colours are called; its arrays have a matrix, too."""

    matrix = [1, 2, 3, 4, 5, 6]


def test_objects_of_mitsuba_are_understood():
    moved = Mitsubas(T().translate([0.3, 0, 0]).matrix.tolist())
    ours = pixels(et.load_dict(scene(ball=ball(to_world=T().translate([0.3, 0, 0])))))
    assert np.array_equal(pixels(et.load_dict(scene(ball=ball(to_world=moved)))), ours)
    colour = pixels(et.load_dict(with_bsdf(type="diffuse", reflectance=Color3f([0.9, 0.1, 0.1]))))
    named = with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": [0.9, 0.1, 0.1]})
    assert np.array_equal(colour, pixels(et.load_dict(named)))
    with pytest.raises(et.SceneError, match="ball.to_world: error: a transform has 4 × 4 numbers, not 2 × 2"):
        et.load_dict(scene(ball=ball(to_world=Mitsubas([[1, 0], [0, 1]]))))


def test_an_id_beats_a_key():
    clay, chalk = ({"type": "diffuse", "reflectance": {"type": "rgb", "value": grey}} for grey in (0.1, 0.9))
    parts = dict(clay={**clay, "id": "chalk"}, chalk=chalk, ball=ball(bsdf={"type": "ref", "id": "chalk"}))
    by_key = dict(clay=clay, ball=ball(bsdf={"type": "ref", "id": "clay"}))
    assert np.array_equal(pixels(et.load_dict(scene(**parts))), pixels(et.load_dict(scene(**by_key))))
    # With an `id` it is also known by its key.
    parts["ball"]["bsdf"]["id"] = "clay"
    assert np.array_equal(pixels(et.load_dict(scene(**parts))), pixels(et.load_dict(scene(**by_key))))
