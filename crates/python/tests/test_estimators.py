"""Comparisons of estimators."""

from pathlib import Path

import etalon as et
import pytest

CORNELL = Path(__file__).resolve().parents[3] / "scenes/cornell-box/scene.xml"


@pytest.fixture(scope="module")
def cornell():
    return et.load_file(CORNELL, resx=16, resy=16)


def test_figures_and_verdicts(cornell, tmp_path):
    told = []
    found = et.estimators(cornell, ["path", "direct"], seconds=3, seed=5, progress=told.append)
    assert found.keys() == list(found) == ["path", "direct"] and len(found) == 2
    path, direct = found["path"], found["direct"]
    # Without indirect light the picture is darker: by more than a tenth in every channel, which no noise here reaches.
    assert found.verdict == "different" and not found and direct.mean[1] < 0.9 * path.mean[1]
    low, high = direct.differences["G"]
    assert low < direct.mean[1] / path.mean[1] - 1 < high < -0.1 and path.differences == {}
    for one in (path, direct):
        assert one.pictures >= 8 and one.spp >= 1 and one.seconds > 0
        assert one.efficiency == pytest.approx(1 / (one.relative_mse * one.seconds), rel=0.2)
        low, high = one.intervals["efficiency"]
        assert low < one.efficiency < high
        assert one.relative_mse == pytest.approx(one.variance + one.bias_squared, rel=0.3)
    assert path.gain is None and direct.gain == pytest.approx(direct.efficiency / path.efficiency, rel=1e-6)
    assert direct.bias_squared > 0.01 > abs(path.bias_squared)
    assert found.findings["estimators"][1]["means"][1] == direct.mean[1]
    assert told == sorted(told) and told[-1] == 1
    assert "relMSE" in str(found) and "different" in repr(found) and "direct" in repr(direct)
    found.report(tmp_path / "page.html")
    assert 'et.estimators(scene' in (tmp_path / "page.html").read_text()
    with pytest.raises(OSError, match="no such folder"):
        found.report(tmp_path / "nowhere/page.html")
    with pytest.raises(KeyError, match="there are path, direct"):
        found["bdpt"]


def test_right_ones_agree():
    # A sky over a plane: whatever chooses the samples, the mean is the same.
    scene = et.load_dict({
        "type": "scene",
        "sensor": {"type": "perspective", "to_world": et.Transform().look_at([0, -4, 2], [0, 0, 0], [0, 0, 1]),
                   "film": {"type": "hdrfilm", "width": 12, "height": 12}},
        "light": {"type": "constant"},
        "floor": {"type": "rectangle", "bsdf": {"type": "diffuse", "reflectance": 0.5}},
    })
    found = et.estimators(scene, samplers=["independent", "sobol"], seconds=2, tolerance=0.05)
    assert found and found.verdict == "equivalent" and found.keys() == ["independent", "sobol"]
    strict = et.estimators(scene, samplers=["independent", "sobol"], seconds=1, tolerance=1e-9)
    assert strict.verdict == "inconclusive" and not strict


def test_mistakes(cornell):
    with pytest.raises(ValueError, match="`path` alone is no comparison"):
        et.estimators(cornell, ["path"], seconds=1)
    with pytest.raises(et.SceneError, match="pth"):
        et.estimators(cornell, ["path", "pth"], seconds=1)
    with pytest.raises(ValueError, match="not enough for 2 estimators: .* s would do"):
        et.estimators(cornell, ["path", "direct"], seconds=1e-3)
    with pytest.raises(ValueError, match="positive number of seconds"):
        et.estimators(cornell, ["path", "direct"], seconds=-1)
    with pytest.raises(ValueError, match="tolerance is 2"):
        et.estimators(cornell, ["path", "direct"], seconds=1, tolerance=2)
    with pytest.raises(TypeError):
        et.estimators(cornell, ["path", "direct"])


def test_ctrl_c_stops(cornell, interrupted):
    interrupted(lambda: et.estimators(cornell, ["path", "direct"], seconds=60))
