"""Notebooks run from top to bottom, and keep outputs that the code still gives."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


def streams(notebook) -> list[str]:
    """What each cell printed, however many pieces it came in: that is a matter of time."""
    cells = [cell.get("outputs", []) for cell in notebook.cells]
    texts = ["".join(o.text for o in c if o.output_type == "stream") for c in cells]
    return [text for text in texts if text]


def pictures(notebook) -> int:
    outputs = [o for cell in notebook.cells for o in cell.get("outputs", [])]
    return sum("image/png" in o.get("data", {}) for o in outputs)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the kernel's transport, not of the library
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_its_outputs_are_kept(path):
    kept = nbformat.read(path, as_version=4)
    run = nbformat.read(path, as_version=4)
    for cell in run.cells:
        if cell.cell_type == "code":
            cell.outputs = []
    beside = {"metadata": {"path": str(path.parent)}}  # as Jupyter does: data lie there
    NotebookClient(run, timeout=300, kernel_name="python3", resources=beside).execute()
    assert pictures(kept) == pictures(run) >= 3
    # Words agree; digits may differ in the last places from machine to machine.
    words = [[w for w in t.split() if w.isalpha()] for t in streams(kept)]
    assert words == [[w for w in t.split() if w.isalpha()] for t in streams(run)]
    assert words


def test_there_is_a_notebook():
    assert NOTEBOOKS
