"""What `pip install .` does for a user, offline: a wheel, installed in a new environment, is asked. Prints what failed."""

import os
import pathlib
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


def main():
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", str(place / "venv")], check=True)
        python = str(place / "venv/bin/python3")
        subprocess.run([python, "-m", "pip", "wheel", "--no-index", "--no-deps", "-w", str(place), "."], check=True,
                       cwd=REPOSITORY)
        (wheel,) = place.glob("rollfix-*.whl")
        subprocess.run([python, "-m", "pip", "install", "--no-index", str(wheel)], check=True)
        asked = "import rollfix; print(rollfix.__file__, rollfix.Part.gallery('ellipse').locate(1.0, 0.5))"
        installed = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}  # and no other
        out = subprocess.run([python, "-c", asked], check=True, capture_output=True, text=True, cwd=place,
                             env=installed).stdout
        assert "venv" in out and "ambiguous (4)" in out, out
        libraries = subprocess.run(["ldd", *map(str, (place / "venv").rglob("_core*.so"))], check=True, capture_output=True,
                                   text=True).stdout
        assert "libfmt" not in libraries, libraries


if __name__ == "__main__":
    main()
