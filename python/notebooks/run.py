#!/usr/bin/env python3
"""Runs the notebooks, and writes their outputs into them; --check only says whether they run without an error.

    PYTHONPATH=build/release/python /usr/bin/python3 python/notebooks/run.py [--check] [NOTEBOOK...]
"""

import argparse
import pathlib
import sys

import nbformat
from nbclient import NotebookClient

FOLDER = pathlib.Path(__file__).resolve().parent


def code_of(notebook):
    return [cell.source for cell in notebook.cells if cell.cell_type == "code"]


def without_noise(notebook):
    """What differs from run to run is not kept: times of execution, and ids that nothing refers to."""
    for number, cell in enumerate(notebook.cells):
        cell.metadata = {}
        cell["id"] = f"cell-{number}"
    notebook.metadata = {"kernelspec": {"name": "python3", "language": "python", "display_name": "Python 3"},
                         "language_info": {"name": "python"}}
    return notebook


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebooks", nargs="*", type=pathlib.Path, default=sorted(FOLDER.glob("*.ipynb")))
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    failed = False
    for path in options.notebooks:
        notebook = nbformat.read(path, as_version=4)
        kept = [bool(cell.outputs) for cell in notebook.cells if cell.cell_type == "code"]
        if options.check and not any(kept):
            print(f"{path.name}: has no outputs; run {pathlib.Path(__file__).name} without --check")
            failed = True
        NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}},
                       record_timing=False).execute()
        print(f"{path.name}: {len(code_of(notebook))} cells run")
        if not options.check:
            nbformat.write(without_noise(notebook), path)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
