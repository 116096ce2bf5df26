"""The notebook, run as Jupyter would: one cell after the other in one namespace."""

import json
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).resolve().parents[3] / "docs/notebooks/first-steps.ipynb"


def code_cells():
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in cells if cell["cell_type"] == "code"]


def test_outputs_are_stripped():
    assert len(code_cells()) > 5
    for cell in code_cells():
        assert (cell["outputs"], cell["execution_count"]) == ([], None)


def test_cells_run(monkeypatch):
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(NOTEBOOK.parent)
    names = {}
    for cell in code_cells():
        exec(compile("".join(cell["source"]), cell["id"], "exec"), names)
    assert names["image"]._repr_png_().startswith(b"\x89PNG")
    assert names["slope"] == pytest.approx(-0.5, abs=0.05)
    assert names["estimators_agree"].verdict == "equivalent"
    # What is measured by the clock may be too little on a busy machine, and then says so.
    assert names["measured"].verdict in ("equivalent", "inconclusive")
    assert names["verdict"].verdict == "equivalent" and names["mistake"].verdict == "different"
