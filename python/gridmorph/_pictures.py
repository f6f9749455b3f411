"""Pictures of meshes: the scripts picture (blocks) and picture-unstructured (elements), which come with the package, each in a process of its own."""
import argparse
import glob
import os
import subprocess
import sys

_HERE = os.path.dirname(os.path.abspath(__file__))


def _script(name):
    """The path of a script: beside the package, or in the sources it is built from."""
    for folder in (os.path.join(_HERE, "scripts"), os.environ.get("GRIDMORPH_SCRIPTS", "")):
        path = os.path.join(folder, name)
        if os.path.exists(path):
            return path
    raise FileNotFoundError(f"the script '{name}', which draws, is not part of this installation: name its folder in GRIDMORPH_SCRIPTS")


def _run(name, *arguments):
    # -B: what cannot be written beside the scripts (another user's installation) is not tried.
    return subprocess.run([sys.executable, "-B", _script(name), *arguments], check=False).returncode


def _is_unstructured(path):
    """Whether the first zone is one of elements. Files of other formats and of no format are left to the scripts, which say what is wrong."""
    if os.path.splitext(path)[1].lower() == ".su2":
        return True
    import h5py

    if not (os.path.isfile(path) and h5py.is_hdf5(path)):
        return False
    with h5py.File(path, "r") as file:
        def label(group):
            return bytes(group.attrs.get("label", b"")).rstrip(b"\0")

        def below(group, wanted):
            return (item for item in group.values() if isinstance(item, h5py.Group) and label(item) == wanted)

        for base in below(file, b"CGNSBase_t"):
            for zone in below(base, b"Zone_t"):
                kinds = [bytes(bytearray(kind[" data"][...].astype("uint8"))) for kind in below(zone, b"ZoneType_t")]
                return any(kind.startswith(b"Unstructured") for kind in kinds)
    return False


def view(arguments):
    """Draws what `scripts/picture` or `scripts/picture-unstructured` draws with these arguments; returns the exit status."""
    meshes = [a for a in arguments if not a.startswith("-")]
    if not meshes:
        print(f"{'' if {'-h', '--help'} & set(arguments) else 'gridmorph: error: view needs a mesh. '}"
              "Usage: python -m gridmorph view BASE.cgns [MORPHED.cgns] --out DIR [options]\n")
        for name in ("picture", "picture-unstructured"):
            _run(name, "--help")
        return 0 if {"-h", "--help"} & set(arguments) else 2
    return _run("picture-unstructured" if _is_unstructured(meshes[0]) else "picture", *arguments)


def folder_of_demo(arguments):
    """Where the command's demo leaves its files."""
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("-d", "--directory")
    known, others = parser.parse_known_args(arguments)
    names = [a for a in others if not a.startswith("-")]
    return known.directory or "demo_" + names[0]


def draw_demo(folder):
    """Draws the meshes that a demo left: baseline beside morphed mesh. Returns the exit status; meshes that nothing was morphed from have none."""
    status = 0
    for morphed in sorted(glob.glob(os.path.join(folder, "passage_*.cgns"))):
        status = max(status, _run("picture", os.path.join(folder, "passage.cgns"), morphed, "--out", morphed[:-len(".cgns")] + "_pictures"))
    ball = os.path.join(folder, "ball_swing.cgns")
    if os.path.exists(ball):
        status = max(status, _run("picture-unstructured", os.path.join(folder, "ball.cgns"), ball, "--stages", os.path.join(folder, "stages"),
                                  "--out", os.path.join(folder, "pictures")))
    return status
