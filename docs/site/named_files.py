"""Files of the repository that pages name in code."""
import re
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
ROOTS = ("", "kernels/gridmorph/", "src/gridmorph/")  # where pages begin to count the path of a file
NAMED_FILE = re.compile(r"(?<![\[`])`([\w./-]+/[\w.-]+\.(?:hpp|cpp|py|md|toml|csv|awk))`(?![`\]])")


def file_named(name):
    """The file of the repository that a page calls so, or None."""
    return next((root + name for root in ROOTS if (REPOSITORY / root / name).is_file()), None)
