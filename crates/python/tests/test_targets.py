"""Renders to an error and for a time."""

import os
import subprocess
import time
from pathlib import Path

import etalon as et
import numpy as np
import pytest

CORNELL = Path(__file__).resolve().parents[3] / "scenes/cornell-box/scene.xml"
RARE = """<scene version="3.0.0">
  <integrator type="path"><boolean name="hide_emitters" value="false"/></integrator>
  <sensor type="perspective"><sampler type="independent"/>
    <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film>
  </sensor>
  <shape type="sphere"><point name="center" x="0.3" y="0.2" z="9"/><float name="radius" value="0.12"/>
    <emitter type="area"><rgb name="radiance" value="100"/></emitter>
  </shape>
</scene>"""


@pytest.fixture(scope="module")
def cornell():
    return et.load_file(CORNELL, resx=24, resy=24)


def relative_error(image):
    """e = √(Σ ⟨s²⟩ / Σ m²), of the arrays."""
    squares = (image.standard_error().astype(float) ** 2).mean(axis=(0, 1)).sum()
    return np.sqrt(squares / (image.numpy().astype(float).mean(axis=(0, 1)) ** 2).sum())


def test_an_error_is_reached(cornell):
    told = []
    image = et.render(cornell, seed=3, error=0.2, progress=told.append)
    assert image.relative_standard_error == pytest.approx(relative_error(image))
    assert image.relative_standard_error <= 0.2 and image.notes == []
    # Not by far more samples than needed.
    assert image.relative_standard_error > 0.2 / 3
    assert told == sorted(told) and told[-1] == 1
    finer = et.render(cornell, seed=3, error=0.1, threads=1)
    assert finer.metadata["spp"] == pytest.approx(4 * image.metadata["spp"], rel=0.1)


def test_a_missed_error_is_told():
    # A small bright light that few samples find: where the pilot finds less of it than there is, too few samples are taken.
    rare = et.load_string(RARE)
    missed, reached = (et.render(rare, seed=seed, error=0.3) for seed in (0, 1))
    assert missed.relative_standard_error > 0.3 and "the target is missed" in missed.notes[0]
    assert reached.relative_standard_error <= 0.3 and reached.notes == []


def test_the_pilot_is_no_part_of_the_image(cornell):
    image = et.render(cornell, seed=5, error=0.1)
    facts = image.metadata
    again = et.render(cornell, seed=5, spp=facts["spp"], replicates=facts["replicates"])
    assert np.array_equal(again.numpy(), image.numpy()) and again.metadata["spp"] == facts["spp"]
    fixed = et.render(cornell, seed=5, error=0.1, replicates=16)
    assert fixed.metadata["replicates"] == 16 and fixed.relative_standard_error < 0.1


@pytest.mark.skipif("ETALON_BINARY" not in os.environ, reason="needs a binary of the same source")
def test_bits_are_those_of_the_binary(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    command = [os.environ["ETALON_BINARY"], "render", str(CORNELL), "-o", str(tmp_path / "binary.exr")]
    subprocess.run(command + "--error 0.2 --seed 7 -D resx=20 -D resy=12 -q".split(), check=True)
    et.render(et.load_file(CORNELL, resx=20, resy=12), error=0.2, seed=7).save(tmp_path / "module.exr")
    assert (tmp_path / "module.exr").read_bytes() == (tmp_path / "binary.exr").read_bytes()


def test_a_time_is_kept(cornell):
    began = time.monotonic()
    short = et.render(cornell, seconds=0.3)
    between = time.monotonic()
    # The machine may be busy: bounds that an ignored time, in either direction, does not keep.
    assert between - began < 5
    long = et.render(cornell, seconds=3)
    assert 0.5 < time.monotonic() - between < 15
    assert long.metadata["spp"] > short.metadata["spp"]


def test_one_aim_at_a_time(cornell):
    for wrong, words in [
        (dict(spp=4, error=0.1), "spp and error each fix"),
        (dict(error=0.1, seconds=1), "error and seconds each fix"),
        (dict(error=0), "error is 0: it must lie between"),
        (dict(error=float("nan")), "error is NaN"),
        (dict(replicates=5000), "replicates is 5000"),
        (dict(seconds=-1), "seconds is -1: it must lie between"),
    ]:
        with pytest.raises(ValueError, match=words):
            et.render(cornell, **wrong)
    dark = et.load_string("""<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">
        <integer name="width" value="4"/><integer name="height" value="4"/></film></sensor></scene>""")
    with pytest.raises(et.SceneError, match="the pilot found no light"):
        et.render(dark, error=0.1)


def test_ctrl_c_stops(cornell, interrupted):
    interrupted(lambda: et.render(cornell, error=1e-3))
