"""Questions to other renderers: one that knows glowing walls, up to a factor, and nothing else."""

import os
from pathlib import Path

import etalon as et
import pytest

RENDERER = """
import json, random, struct, sys
scene, seed, out, factor = json.load(open(sys.argv[1])), int(sys.argv[2]), sys.argv[3], float(sys.argv[4])
if scene["question"] != "wall":
    print("no such thing", file=sys.stderr)
    sys.exit(3)
pixels, radiance = scene["pixels"], scene["objects"][0]["emitted_radiance"]
noise = random.Random(seed)
samples = [factor * radiance * (1 + noise.gauss(0, 0.01)) for _ in range(3 * pixels**2)]
with open(out, "wb") as file:
    file.write(f"PF\\n{pixels} {pixels}\\n-1.0\\n".encode() + struct.pack(f"<{len(samples)}f", *samples))
"""


def driver(folder, factor):
    (folder / "walls.py").write_text(RENDERER)
    path = folder / f"walls-{factor}.toml"
    path.write_text(f"""
name = "walls"
title = "Walls alone"
version = ["{{python}}", "-c", "print('walls 1.0')"]
command = ["{{python}}", "{{driver}}", "{{scene}}", "{{seed}}", "{{out}}", "{factor}"]
script = "walls.py"
picture = "pfm"
""")
    return path


def test_verdicts(tmp_path):
    right = et.conform(driver(tmp_path, 1), tmp_path / "right", questions=["wall", "sun-unit"], tier="quick")
    assert right and right.verdict == "agrees"
    assert right.verdicts == {"wall": "agrees", "sun-unit": "not supported"}
    assert "Walls alone (walls 1.0), 2 questions" in str(right) and "agrees" in repr(right)
    assert right.findings["plan"]["program_version"] == "walls 1.0"
    right.report(tmp_path / "page.html")
    assert "Walls alone" in (tmp_path / "page.html").read_text()
    wrong = et.conform(driver(tmp_path, 1.05), tmp_path / "wrong", questions=["wall"], tier="quick")
    assert not wrong and wrong.verdict == "differs"
    low, high = wrong.findings["rows"][0]["interval"]
    assert 0.04 < low < 0.05 < high < 0.06


def test_mistakes(tmp_path):
    toml = driver(tmp_path, 1)
    for wrong, words in [
        (dict(questions=["wal"]), "there is no question `wal`: did you mean `wall`"),
        (dict(tier="slow"), 'tier is "slow": expected `quick`'),
        (dict(questions=["sphere-light-large"], tier="quick"), "asks none"),
        (dict(python="absent-python"), "absent-python: "),
    ]:
        with pytest.raises(ValueError, match=words):
            et.conform(toml, tmp_path / "run", **wrong)
    with pytest.raises(ValueError, match="there is no driver `mitsba`"):
        et.conform("mitsba", tmp_path / "run")
    with pytest.raises(ValueError, match="absent.toml"):
        et.conform(tmp_path / "absent.toml", tmp_path / "run")


@pytest.mark.skipif("ETALON_BINARY" not in os.environ, reason="needs a binary of the same source")
def test_the_binary_agrees(tmp_path):
    asked = et.conform("etalon", tmp_path, questions=["wall"], tier="quick", etalon=os.environ["ETALON_BINARY"])
    assert asked.verdicts == {"wall": "agrees"} and asked.findings["plan"]["title"] == "Etalon"
    assert Path(tmp_path / "plan.json").is_file()
