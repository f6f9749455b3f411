"""Pictures of what the command's demo left, drawn by its `view`."""
import argparse
import glob
import os
import subprocess


def folder_of_demo(arguments):
    """Where the command's demo leaves its files."""
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("-d", "--directory")
    known, others = parser.parse_known_args(arguments)
    names = [a for a in others if not a.startswith("-")]
    return known.directory or "demo_" + names[0]


def draw_demo(command, folder):
    """Draws the meshes that a demo left: baseline beside morphed mesh. Returns the exit status; meshes that nothing was morphed from have none."""
    def view(*words):
        return subprocess.run([command, "view", *words], check=False).returncode

    status = 0
    for morphed in sorted(glob.glob(os.path.join(folder, "passage_*.cgns"))):
        status = max(status, view(os.path.join(folder, "passage.cgns"), morphed, "--out", morphed[:-len(".cgns")] + "_pictures"))
    ball = os.path.join(folder, "ball_swing.cgns")
    if os.path.exists(ball):
        status = max(status, view(os.path.join(folder, "ball.cgns"), ball, "--stages", os.path.join(folder, "stages"),
                                  "--out", os.path.join(folder, "pictures")))
    return status
