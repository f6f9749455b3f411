"""The gridmorph command, as it comes with the package: python -m gridmorph COMMAND ...

Everything the command does, and one thing more: `demo` draws pictures of what it made:

    python -m gridmorph demo                                    a passage, morphed twice, in demo_passage
    python -m gridmorph morph case.toml
    python -m gridmorph view passage.cgns moved.cgns --out pictures
"""
import os
import shutil
import subprocess
import sys

from . import _pictures


def executable():
    """The path of the command: the package's own, GRIDMORPH_EXECUTABLE where that is set, else the first one of PATH."""
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "gridmorph")
    for path in (os.environ.get("GRIDMORPH_EXECUTABLE"), own):
        if path and os.access(path, os.X_OK):
            return path
    found = shutil.which("gridmorph")
    if found is None:
        raise FileNotFoundError("the gridmorph command is not part of this installation: name it in GRIDMORPH_EXECUTABLE")
    return found


def _demo(arguments):
    command = executable()
    status = subprocess.run([command, "demo", *arguments], check=False).returncode
    if status not in (0, 1) or "--help" in arguments or "-h" in arguments:
        return status
    return _pictures.draw_demo(command, _pictures.folder_of_demo(arguments)) or status


def main(arguments=None):
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    try:
        if arguments[:1] == ["demo"]:
            return _demo(arguments[1:] if len(arguments) > 1 and not arguments[1].startswith("-") else ["passage", *arguments[1:]])
        program = executable()
        sys.stdout.flush()
        if os.name == "posix":
            os.execv(program, [program, *arguments])
        return subprocess.run([program, *arguments], check=False).returncode
    except OSError as error:
        print(f"gridmorph: error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
