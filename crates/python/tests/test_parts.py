"""Parts that are merged, and pictures that are denoised."""

import os
import subprocess
from pathlib import Path

import etalon as et
import numpy as np
import pytest

CORNELL = Path(__file__).resolve().parents[3] / "scenes/cornell-box/scene.xml"


@pytest.fixture(scope="module")
def cornell():
    return et.load_file(CORNELL, resx=24, resy=20)


@pytest.fixture(scope="module")
def parts(cornell):
    return [et.render(cornell, spp=32, seed=3, part=(k, 3)) for k in (1, 2, 3)]


def test_parts_are_the_whole(cornell, parts, tmp_path):
    whole = et.render(cornell, spp=32, seed=3)
    assert sum(part.metadata["replicates"] for part in parts) == 8
    for index, part in enumerate(parts):
        part.save(tmp_path / f"{index}.exr")
    merged = et.merge([tmp_path / "2.exr", parts[0], et.read(tmp_path / "1.exr")])
    for array in (et.Image.numpy, et.Image.standard_error, et.Image.tiles):
        assert np.array_equal(array(merged), array(whole))
    assert merged.metadata["spp"] == 32
    # Parts of parts: what is still missing may come later.
    larger = et.merge(parts[:2], partial=True)
    larger.save(tmp_path / "larger.exr")
    assert np.array_equal(et.merge([parts[2], tmp_path / "larger.exr"]).numpy(), whole.numpy())
    assert np.array_equal(parts[0].numpy(), et.render(cornell, spp=32, seed=3, part=(1, 3)).numpy())


def test_parts_that_cannot_be_merged(cornell, parts, tmp_path):
    parts[0].save(tmp_path / "first.exr")
    et.render(cornell, spp=8).save(tmp_path / "whole.exr")
    for wrong, words in [
        ([], "nothing to merge"),
        (parts[:2], "replicates are missing: .*partial=True"),
        ([parts[0], tmp_path / "first.exr"], "image 1 and .*first.exr cannot be merged: both have the replicates"),
        ([parts[0], et.render(cornell, spp=32, seed=4, part=(2, 3))], "image 1 and image 2 cannot be merged: .*seed"),
        ([et.render(cornell, spp=8)], "image 1 is no part"),
        ([tmp_path / "whole.exr"], "whole.exr.*part"),
    ]:
        with pytest.raises(ValueError, match=words):
            et.merge(wrong)
    with pytest.raises(FileNotFoundError):
        et.merge([tmp_path / "absent.exr"])
    for wrong in [dict(part=(0, 2)), dict(part=(3, 2)), dict(part=(1, 9)), dict(part=(1, 0))]:
        with pytest.raises(ValueError, match="part is "):
            et.render(cornell, spp=32, **wrong)
    with pytest.raises(ValueError, match="a part has spp"):
        et.render(cornell, error=0.1, part=(1, 2))


def test_less_noise(cornell, tmp_path):
    box = et.load_file(CORNELL, resx=48, resy=48)
    noisy = et.render(box, spp=16, seed=1, features=True)
    denoised = et.denoise(noisy)
    truth = et.render(box, spp=1024, seed=2).numpy().astype(float)

    def error(image):
        return np.sqrt(((image.numpy() - truth) ** 2 / (truth**2 + 0.01)).mean())

    # A filter that does nothing has the ratio 1; this one had 0.52 to 0.58 with three seeds.
    assert error(denoised) < 0.75 * error(noisy)
    # The stated error estimates the true one: in three seeds the ratio was 0.93 to 1.21. The noise of before has 1.7 or more.
    assert 0.7 < denoised.mean_relative_standard_error / error(denoised) < 1.5
    assert "regression" in denoised.metadata["denoised"]
    assert et.compare(denoised, noisy).verdict == "inconclusive"
    noisy.save(tmp_path / "noisy.exr")
    assert np.array_equal(et.denoise(tmp_path / "noisy.exr").numpy(), denoised.numpy())
    with pytest.raises(ValueError, match="the image: .*features"):
        et.denoise(et.render(cornell, spp=8))
    with pytest.raises(ValueError, match="Open Image Denoise 2 cannot be loaded"):
        et.denoise(noisy, oidn=tmp_path)


@pytest.mark.skipif("ETALON_BINARY" not in os.environ, reason="needs a binary of the same source")
def test_bits_are_those_of_the_binary(cornell, parts, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")

    def etalon(*words):
        subprocess.run([os.environ["ETALON_BINARY"], *map(str, words), "-q"], check=True)

    box = [CORNELL, "-D", "resx=24", "-D", "resy=20", "--spp", 32, "--seed", 3]
    etalon("render", *box, "--part", "2/3", "-o", tmp_path / "two.exr")
    assert np.array_equal(et.merge([parts[2], tmp_path / "two.exr", parts[0]]).numpy(), et.merge(parts).numpy())
    etalon("render", *box, "--features", "-o", tmp_path / "noisy.exr")
    etalon("denoise", tmp_path / "noisy.exr", "-o", tmp_path / "denoised.exr")
    et.denoise(et.render(cornell, spp=32, seed=3, features=True)).save(tmp_path / "ours.exr")
    assert (tmp_path / "ours.exr").read_bytes() == (tmp_path / "denoised.exr").read_bytes()
