"""Mistakes in dicts have the path of keys that leads to them."""

from pathlib import Path

import etalon as et
import numpy as np
import pytest
from dict_scenes import ball, scene, with_bsdf


def circular():
    bsdf = {"type": "twosided"}
    bsdf["inner"] = bsdf
    return scene(ball=ball(bsdf=bsdf))


MESH = {
    "type": "mesh",
    "vertices": np.array([[-1, 0, -1], [1, 0, -1], [0, 0.3, 1]], dtype=np.float32),
    "faces": np.array([[0, 1, 2]]),
}

# Dicts with mistakes, where and what.
BAD = {
    "misspelt plugin": (
        with_bsdf(type="difuse"),
        "ball.bsdf.type",
        "there is no plugin `difuse` (did you mean `diffuse`?)",
    ),
    "another program's plugin": (with_bsdf(type="glass"), "ball.bsdf.type", "did you mean `dielectric`?"),
    "misspelt parameter": (scene(ball={"type": "sphere", "radus": 1}), "ball.radus", "did you mean `radius`?"),
    "refused value": (scene(ball=ball(radius=-1)), "ball.radius", "cannot be -1"),
    "wrong kind": (scene(ball=ball(radius="big")), "ball.radius", "must be a number, not a string"),
    "no type": (scene(ball={"radius": 1}), "ball", "the dict with the keys radius has no `type`"),
    "type is no string": (scene(ball={"type": 3}), "ball.type", "it is a string, not an int"),
    "None": (with_bsdf(type="diffuse", reflectance=None), "ball.bsdf.reflectance", "None can be no value of a scene"),
    "set": (scene(ball=ball(center={1, 2, 3})), "ball.center", "a set can be no value of a scene"),
    "texts for numbers": (scene(ball=ball(center=["1", "2", "3"])), "ball.center", "a list can be no value"),
    "key is no string": (scene(ball=ball(**{}) | {3: 4}), "ball", "the key 3 is no string"),
    "point in a key": (scene(**{"a.b": {"type": "sphere"}}), "a.b", "has no point"),
    "circle": (circular(), "ball.bsdf.inner", "the dict contains itself"),
    "no such reference": (with_bsdf(type="ref", id="cley"), "ball.bsdf", "there is no object with the id `cley`"),
    "id given twice": (
        scene(a={"type": "sphere", "id": "x"}, b={"type": "sphere", "id": "x"}),
        "b",
        "the id `x` is given twice",
    ),
    "reference without id": (with_bsdf(type="ref"), "ball.bsdf", "a `ref` has an `id`"),
    "NaN in a matrix": (
        scene(ball=ball(to_world=np.full((4, 4), np.nan))),
        "ball.to_world",
        "`NaN` is not a finite number",
    ),
    "singular matrix": (scene(ball=ball(to_world=np.diag([1, 1, 0, 1.0]))), "ball.to_world", "cannot be undone"),
    "matrix of 3 × 3": (scene(ball=ball(to_world=np.eye(3))), "ball.to_world", "a transform has 4 × 4 numbers"),
    "four numbers": (scene(ball=ball(center=[1, 2, 3, 4])), "ball.center", "an array of 4 can be no value of a scene"),
    "two numbers in a colour": (
        with_bsdf(type="diffuse", reflectance={"type": "rgb", "value": [1, 2]}),
        "ball.bsdf.reflectance",
        "the value of `rgb` is three numbers or one, not an array of 2",
    ),
    "colour without value": (
        with_bsdf(type="diffuse", reflectance={"type": "rgb"}),
        "ball.bsdf.reflectance",
        "`rgb` has a `value`",
    ),
    "descending wavelengths": (
        with_bsdf(type="diffuse", reflectance={"type": "spectrum", "value": [(500, 1), (400, 1)]}),
        "ball.bsdf.reflectance",
        "wavelengths must ascend",
    ),
    "missing file": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "filename": Path("nowhere.png")}),
        "ball.bsdf.reflectance.filename",
        "the file `nowhere.png` was not found",
    ),
    "picture of two channels": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": np.zeros((3, 4, 2))}),
        "ball.bsdf.reflectance.data",
        "not 3 × 4 × 2",
    ),
    "picture of int64": (
        with_bsdf(type="diffuse", reflectance={"type": "bitmap", "data": np.zeros((3, 4), int)}),
        "ball.bsdf.reflectance.data",
        "not of int64",
    ),
    "volume of two dimensions": (
        scene(ball={"type": "sdfgrid", "data": np.zeros((2, 2))}),
        "ball.data",
        "an array along z, y and x",
    ),
    "vertices in the plane": (scene(ball={**MESH, "vertices": np.zeros((3, 2))}), "ball.vertices", "N × 3, not 3 × 2"),
    "vertex that is not there": (
        scene(ball={**MESH, "faces": [[0, 1, 3]]}),
        "ball.faces",
        "face 0 has the vertex 3, but there are 3",
    ),
    "faces of floats": (scene(ball={**MESH, "faces": [[0, 1, 2.0]]}), "ball.faces", "float64, not integers"),
    "normals of another mesh": (
        scene(ball={**MESH, "normals": np.ones((2, 3))}),
        "ball.normals",
        "2 rows for 3 vertices",
    ),
    "infinite vertex": (scene(ball={**MESH, "vertices": np.full((3, 3), np.inf)}), "ball.vertices", "not finite"),
    "mesh without faces": (scene(ball={"type": "mesh", "vertices": MESH["vertices"]}), "ball.faces", "a mesh needs"),
    "no pairs in an animation": (
        scene(ball=ball(to_world={"type": "animation", "keys": [1, 2]})),
        "ball.to_world.keys",
        "pairs (time, value)",
    ),
    "object in an animation": (
        scene(ball=ball(radius={"type": "animation", "keys": [(0, {"type": "sphere"})]})),
        "ball.radius",
        "the values of an animation are no objects",
    ),
    "times that descend": (
        scene(ball=ball(radius={"type": "animation", "keys": [(1, 0.5), (0, 0.6)]})),
        "ball.radius",
        "the time of a key must be after",
    ),
    "misspelt key of an animation": (
        scene(ball=ball(radius={"type": "animation", "key": [(1, 0.5)]})),
        "ball.radius.key",
        "an animation has `keys`",
    ),
    "no scene": ({"type": "sphere"}, "type", "the outermost dict is a scene"),
    "nothing": ({}, "", "the empty dict has no `type`"),
}


@pytest.mark.parametrize("name", BAD)
def test_mistakes_have_key_paths(name):
    wrong, key, words = BAD[name]
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(wrong)
    lines = str(caught.value).split("\n")
    assert [line for line in lines if line.startswith(f"{key or '<dict>'}: error: ") and words in line], lines
    found = [d for d in caught.value.diagnostics if d["key"] == key]
    assert found and found[0]["severity"] == "error"
    assert len(caught.value.diagnostics) == len(lines)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(scene(ball=ball(radius=None), floor={"type": "rectangl"}))
    assert [d["key"] for d in caught.value.diagnostics] == ["ball.radius", "floor.type"]
    with pytest.raises(et.SceneError) as caught:
        et.load_dict(scene(ball=ball(radius=-2), lamp={"type": "point", "intens": 1.0}))
    assert [d["key"] for d in caught.value.diagnostics] == ["lamp.intens", "ball.radius"]
    with pytest.raises(TypeError):
        et.load_dict("scene")
