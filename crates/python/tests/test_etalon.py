"""The module as its users see it. `ETALON_BINARY` names a binary of the same source, to compare bits with."""

import _thread
import gc
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import etalon as et
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
CORNELL = ROOT / "scenes/cornell-box/scene.xml"
SMALL = """<scene version="3.0.0">
  <default name="glow" value="1"/>
  <sensor type="perspective">
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="4"/></film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="$glow"/></emitter>
</scene>"""


@pytest.fixture(scope="module")
def cornell():
    return et.load_file(CORNELL, resx=32, resy=24)


@pytest.fixture(scope="module")
def image(cornell):
    return et.render(cornell, spp=64, seed=3)


def test_scene_says_what_it_is(cornell):
    assert (cornell.integrator, cornell.size, cornell.notes) == ("path", (32, 24), [])
    assert cornell.defines["resx"] == "32" and cornell.defines["max_depth"] == "8"
    assert "scene.xml, 32 × 24, path" in repr(cornell)


def test_image_has_colour_and_errors(image):
    colour, errors = image.numpy(), image.standard_error()
    assert colour.shape == errors.shape == (24, 32, 3)
    assert colour.dtype == errors.dtype == np.float32
    assert (errors >= 0).all() and 0 < errors.mean() < colour.mean()
    for index, name in enumerate("RGB"):
        assert np.array_equal(image.channel(name), colour[:, :, index])
        assert np.array_equal(image.channel("standard_error." + name), errors[:, :, index])
    assert set(image.channels) >= {"R", "G", "B", "standard_error.G"}
    # The left wall is red, the right one green: neither rows and columns nor channels are mixed up.
    left, right = colour[8:16, 6].mean(axis=0), colour[8:16, -7].mean(axis=0)
    assert left[0] > 2 * left[1] and right[1] > 1.3 * right[0]
    with pytest.raises(ValueError, match="no channel \"Q\"; there are .*R"):
        image.channel("Q")


def test_figures_are_those_of_the_arrays(image):
    facts = image.metadata
    assert (facts["spp"], facts["seed"], facts["replicates"]) == (64, 3, 8)
    assert facts["film"]["crop_size"] == list(image.size) == [32, 24]
    noise = image.standard_error().astype(float) ** 2 / (image.numpy().astype(float) ** 2 + 0.01)
    assert image.mean_relative_standard_error == pytest.approx(np.sqrt(noise.mean()))
    assert "32 × 24" in repr(image) and "%.2f %%" % (100 * np.sqrt(noise.mean())) in repr(image)


def test_tiles_are_means_with_intervals(image):
    tiles = image.tiles(16)
    assert tiles.shape == (2, 2, 3, 3)
    mean, low, high = np.moveaxis(tiles, 3, 0)
    assert mean[0, 1] == pytest.approx(image.numpy()[:16, 16:].mean(axis=(0, 1)), rel=1e-5)
    assert mean[1, 0] == pytest.approx(image.numpy()[16:, :16].mean(axis=(0, 1)), rel=1e-5)
    assert (low < mean).all() and (mean < high).all()
    assert (np.diff(image.tiles(16, confidence=0.5)[..., 1:]) < np.diff(tiles[..., 1:])).all()
    with pytest.raises(ValueError, match="no means of tiles of 7 pixels; there are 16"):
        image.tiles(7)


def test_options_are_those_of_the_scene(cornell, image):
    again = et.render(cornell, spp=64, seed=3, threads=1)
    assert np.array_equal(again.numpy(), image.numpy())
    assert not np.array_equal(et.render(cornell, spp=64, seed=4).numpy(), image.numpy())
    part = et.render(cornell, spp=64, seed=3, crop=(8, 4, 10, 6))
    assert np.array_equal(part.numpy(), image.numpy()[4:10, 8:18])
    assert et.render(cornell, spp=1, size=(6, 5)).size == (6, 5)
    direct = et.render(cornell, spp=64, seed=3, integrator="direct")
    assert direct.metadata["integrator"] == "direct" and direct.numpy().mean() < image.numpy().mean()
    assert et.render(cornell, spp=1, time=0.5).metadata["scene_hash"] != image.metadata["scene_hash"]
    assert cornell.size == (32, 24)
    for wrong in [dict(spp=0), dict(threads=0), dict(threads=9999), dict(time=float("nan")), dict(crop=(30, 0, 9, 9))]:
        with pytest.raises(ValueError):
            et.render(cornell, **wrong)


def test_files_come_back(image, tmp_path):
    image.save(tmp_path / "a.exr")
    image.save(tmp_path / "a.png")
    back = et.read(tmp_path / "a.exr")
    assert np.array_equal(back.numpy(), image.numpy()) and back.metadata == image.metadata
    png = (tmp_path / "a.png").read_bytes()
    assert png.startswith(b"\x89PNG") and png == image._repr_png_()
    with pytest.raises(ValueError, match=".exr or .png"):
        image.save(tmp_path / "a.jpg")
    with pytest.raises(OSError, match="no such folder"):
        image.save(tmp_path / "nowhere/a.exr")
    with pytest.raises(FileNotFoundError):
        et.read(tmp_path / "b.exr")


@pytest.mark.skipif("ETALON_BINARY" not in os.environ, reason="needs a binary of the same source")
def test_bits_are_those_of_the_binary(tmp_path, monkeypatch):
    # Without the time that it took, a file depends on the input alone.
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    command = [os.environ["ETALON_BINARY"], "render", str(CORNELL), "-o", str(tmp_path / "binary.exr")]
    subprocess.run(command + "--spp 16 --seed 7 -D resx=40 -D resy=20 -q".split(), check=True)
    et.render(et.load_file(CORNELL, resx=40, resy=20), spp=16, seed=7).save(tmp_path / "module.exr")
    assert (tmp_path / "module.exr").read_bytes() == (tmp_path / "binary.exr").read_bytes()


def test_mistakes_have_their_places(tmp_path):
    path = tmp_path / "wrong.xml"
    path.write_text(SMALL.replace("perspective", "perspectiv").replace("constant", "konstant"))
    with pytest.raises(et.SceneError) as caught:
        et.load_file(path)
    assert isinstance(caught.value, ValueError)
    first, second = caught.value.diagnostics
    assert (first["severity"], first["file"], first["line"], first["column"]) == ("error", str(path), 3, 17)
    assert "perspectiv" in first["message"] and "perspective" in first["help"]
    assert second["line"] == 6 and "constant" in second["help"]
    lines = str(caught.value).split("\n")
    assert len(lines) == 2 and lines[0].startswith(f"{path}:3:17: error: ")
    with pytest.raises(et.SceneError, match="brightness"):
        et.load_file(CORNELL, brightness=1)
    with pytest.raises(FileNotFoundError):
        et.load_file(tmp_path / "absent.xml")


def test_texts_are_scenes(tmp_path, monkeypatch):
    scene = et.load_string(SMALL, glow=0.25)
    assert "<string>, 8 × 4" in repr(scene) and scene.defines == {"glow": "0.25"}
    assert et.render(scene, spp=256).numpy() == pytest.approx(0.25, rel=0.05)
    assert et.render(scene, spp=1, size=(3, 2)).numpy().shape == (2, 3, 3)
    with pytest.raises(et.SceneError, match=r"^<string>:1:1: error: "):
        et.load_string("<shape/>")
    (tmp_path / "part.xml").write_text(SMALL)
    including = '<scene version="3.0.0"><include filename="part.xml"/></scene>'
    monkeypatch.chdir(tmp_path)
    assert et.load_string(including).size == (8, 4)


def test_verdicts(cornell, image, tmp_path):
    other = et.render(cornell, spp=64, seed=4)
    dark = et.render(cornell, spp=64, seed=5, integrator="direct")
    image.save(tmp_path / "a.exr")
    dark.save(tmp_path / "dark.exr")
    same = et.compare(image, other, tolerance=0.3, tile_tolerance=0.5)
    assert same and same.verdict == "equivalent" and same.interval[0] < 0 < same.interval[1]
    # One in a thousand seeds would fail; these do not.
    assert same.p_value > 0.001 and set(same.p_values) == {"R", "G", "B"}
    different = et.compare(tmp_path / "a.exr", str(tmp_path / "dark.exr"))
    assert not different and different.verdict == "different" and different.p_value < 1e-6
    assert different.interval[0] > 0.1
    open_ = et.compare(image, other, tolerance=1e-5)
    assert not open_ and open_.verdict == "inconclusive" and open_.more_samples > 1
    different.report(tmp_path / "page.html")
    assert "Verdict" in (tmp_path / "page.html").read_text() and "different" in repr(different)
    with pytest.raises(OSError, match="read from"):
        different.report(tmp_path / "a.exr")
    assert et.compare(image, image).p_value == 1
    single = et.compare(image, et.render(cornell, spp=1))
    assert single.verdict == "inconclusive" and single.interval is None
    assert "the second image has a single replicate" in single.notes[0]
    with pytest.raises(ValueError, match="differ in size"):
        et.compare(image, et.render(cornell, spp=2, size=(4, 4)))
    with pytest.raises(ValueError, match="tolerance is 0"):
        et.compare(image, other, tolerance=0)


def test_pictures_of_any_renderer_are_judged(cornell, image):
    rng = np.random.default_rng(1)
    truth = rng.uniform(0.5, 2, (20, 33, 3))
    noisy = [truth + rng.normal(0, 0.05, truth.shape) for _ in range(8)]
    theirs = et.Image.from_replicates(noisy, spp=4, program="theirs 1.0")
    assert theirs.numpy() == pytest.approx(np.mean(noisy, axis=0), rel=1e-5)
    error = np.std(noisy, axis=0, ddof=1) / np.sqrt(8)
    assert theirs.standard_error() == pytest.approx(error, rel=1e-3)
    assert (theirs.metadata["spp"], theirs.metadata["version"]) == (32, "theirs 1.0")
    again = (truth + rng.normal(0, 0.05, truth.shape).astype(np.float32) for _ in range(8))
    same = et.compare(et.Image.from_replicates(again), theirs, tolerance=0.02)
    assert same and same.notes == []
    brighter = et.Image.from_replicates([1.1 * picture for picture in noisy])
    assert et.compare(brighter, theirs).verdict == "different"
    for wrong, words in [
        (noisy[:1], "two or more"),
        ([noisy[0], noisy[0]], "picture 2: it has the pixels of picture 1"),
        ([truth, truth[:5]], "picture 2: .*33 × 5 pixels, not 33 × 20"),
        ([truth[:, :, :2]] * 2, "20 × 33 × 2"),
        ([truth[0]] * 2, "height × width × 3"),
        ([truth * np.nan, truth], "picture 1: pixel"),
    ]:
        with pytest.raises(ValueError, match=words):
            et.Image.from_replicates(wrong)


def test_progress_is_told(cornell, capsys):
    told = []
    et.render(cornell, spp=1024, threads=1, progress=told.append)
    assert told == sorted(told) and told[-1] == 1 and all(0 <= fraction <= 1 for fraction in told)
    et.render(cornell, spp=1, progress=True)
    assert capsys.readouterr().err.endswith("100 %\n")
    et.render(cornell, spp=1, progress=False)
    assert capsys.readouterr().err == ""
    with pytest.raises(TypeError, match="callable"):
        et.render(cornell, progress="yes")

    def refuse(fraction):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        et.render(cornell, spp=1 << 20, progress=refuse)


def test_other_threads_run_and_ctrl_c_stops(cornell):
    began, ticks = time.monotonic(), []

    def tick():
        while time.monotonic() - began < 1:
            ticks.append(0)
            time.sleep(0.01)
        _thread.interrupt_main()
        ticks.append(time.monotonic())

    other = threading.Thread(target=tick)
    other.start()
    with pytest.raises(KeyboardInterrupt):
        et.render(cornell, spp=1 << 24)
    stopped = time.monotonic()
    other.join()
    assert len(ticks) > 30 and stopped - ticks[-1] < 2
    assert et.render(cornell, spp=1).size == (32, 24)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_renders_leave_no_memory_behind(cornell):
    def resident():
        gc.collect()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 2**20

    def render(index):
        # Of 256 × 256 pixels an image has 3 MiB, and its film more: one that stays is seen.
        picture = et.render(cornell, spp=2, seed=index, size=(256, 256))
        return picture.numpy().sum() + picture.tiles().sum()

    for index in range(5):
        render(index)
    before = resident()
    for index in range(20):
        render(index)
    assert resident() - before < 4


def test_the_version_is_that_of_its_images(cornell):
    assert et.__version__ == et.render(cornell, spp=8).metadata["version"]
