#!/usr/bin/env python3
"""build_site.py --gridmorph FILE --out FOLDER: builds the site with mkdocs, strictly, and checks what came out. Python is that of an environment with
mkdocs (scripts/install-dependencies --site). Exit status: 0 done, 1 the pages have a fault, which is named."""
import argparse
import os
import subprocess
import sys
from pathlib import Path

from check_site import problems

HERE = Path(__file__).resolve().parent


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gridmorph", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    out = Path(options.out).resolve()
    environment = {**os.environ, "GRIDMORPH": os.path.abspath(options.gridmorph), "NO_MKDOCS_2_WARNING": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    # Not --quiet: what is not said does not count as a warning.
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--clean", "-f", HERE / "mkdocs.yml", "-d", out]
    built = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if built.returncode != 0:
        print(built.stdout, file=sys.stderr)
    found = list(problems(out)) if built.returncode == 0 else []
    for line in found:
        print("site:", line, file=sys.stderr)
    sys.exit(1 if built.returncode != 0 or found else 0)


if __name__ == "__main__":
    main()
