"""What the site needs beyond the pages of docs/: what they link to elsewhere in the repository, three pages made of other
sources (keys of case files, twice, and the command line), formulas as MathML. mkdocs calls the on_ functions."""
import json
import os
import posixpath
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import latex2mathml.converter
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

sys.path.insert(0, str(Path(__file__).parent))
from case_keys import index_page, reference_page, with_anchors  # noqa: E402
from named_files import NAMED_FILE, REPOSITORY, file_named  # noqa: E402

LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".toml": "toml", ".py": "python", ".cmake": "cmake", ".txt": "text", ".awk": "awk", ".csv": "text"}
LINK = re.compile(r"(?<=\]\()(?![a-z]+:|#|/)([^)#\s]+)(?=[)#])")
FILE_AS_TEXT = re.compile(r"\[(?:[\w./-]*/)?([\w-]+\.md)\](?=\(([^)#\s]*\1)(?:#[^)\s]*)?\))")
CODE = re.compile(r"(^(`{3,}).*?^\2`*[ \t]*$|`[^`\n]+`)", re.M | re.S)
FORMULA = re.compile(r'<(span|div) class="arithmatex">(\\\(|\\\[)(.*?)(\\\)|\\\])</\1>', re.S)
HIDDEN = "---\nsearch:\n  exclude: true\n---\n"  # what the search would find too much of


def outside_code(text, change):
    """The text, with change(part) in place of all parts that are not code."""
    pieces = CODE.split(text)
    return "".join(change(piece) if n % 3 == 0 else piece if n % 3 == 1 else "" for n, piece in enumerate(pieces))


def shown_for(path):
    """What the site shows for a file or folder of the repository: itself, or the folder's README.md."""
    return f"{path}/README.md" if (REPOSITORY / path / "README.md").exists() else path


def page_of(path):
    """Where the site has a file or folder of the repository: pages of docs/ at the top, all else below repository/."""
    path = shown_for(path)
    if path.startswith("docs/"):
        return path[5:]
    return f"repository/{path}" + ("" if path.endswith(".md") else "/index.md" if (REPOSITORY / path).is_dir() else ".md")


def path_of(page):
    """The file that a page shows; the inverse of page_of() for Markdown."""
    return page[len("repository/"):] if page.startswith("repository/") else f"docs/{page}"


def without_fences(text, change):
    """The text, with change(line) in place of all lines that are neither code blocks nor headings."""
    inside, lines = False, text.split("\n")
    for n, line in enumerate(lines):
        fence = line.lstrip().startswith("```")
        inside ^= fence
        if not (inside or fence or line.startswith("#")):
            lines[n] = change(line)
    return "\n".join(lines)


def links_of(path, text):
    """Files and folders of the repository that Markdown at path links to, or names in code."""
    found = []
    outside_code(text, lambda part: found.extend(LINK.findall(part)) or part)
    targets = [posixpath.normpath(posixpath.join(posixpath.dirname(path), link)) for link in found]
    without_fences(text, lambda line: targets.extend(filter(None, map(file_named, NAMED_FILE.findall(line)))) or line)
    return [target for target in targets if not target.startswith("..") and (REPOSITORY / target).exists()]


def markdown_of(path):
    """The Markdown of a page that shows a file or folder of the repository, or None where it is no text."""
    where = REPOSITORY / path
    if where.is_dir():
        names = sorted(f"{p.name}/" if p.is_dir() else p.name for p in where.iterdir() if not p.name.startswith((".", "__")))
        return f"{HIDDEN}# {path}/\n\n" + "".join(f"- `{name}`\n" for name in names)
    try:
        text = where.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None
    if path.endswith(".md"):
        return text if text.startswith("# ") else f"# {where.name}\n\n{text}"
    fence = "`" * max([3] + [len(run) + 1 for run in re.findall(r"`{3,}", text)])
    language = LANGUAGES.get(where.suffix, "bash" if text.startswith("#!/usr/bin/env bash") else "text")
    return f"{HIDDEN}# {path}\n\n{fence}{language}\n{text.rstrip()}\n{fence}\n"


def on_files(files, config):
    """Adds what pages link to outside docs/, what that links to, and the pages that are made."""
    todo = [path_of(f.src_uri) for f in files.documentation_pages()]
    seen = set(todo)
    while todo:
        path = todo.pop()
        for target in map(shown_for, links_of(path, (REPOSITORY / path).read_text(encoding="utf-8"))):
            if target in seen or target.startswith("docs/"):
                continue
            seen.add(target)
            text = markdown_of(target)
            if text is not None:
                files.append(File.generated(config, page_of(target), content=text))
            if target.endswith(".md"):
                todo.append(target)
    files.append(File.generated(config, "case_keys.md", content=index_page((REPOSITORY / "docs/case_file.md").read_text(encoding="utf-8"))))
    files.append(File.generated(config, "case_reference.md", content=reference_page(json.loads(said("keys", "--json"))["keys"])))
    files.append(File.generated(config, "command_line.md", content=command_line()))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links lead to where the site has what they name, and files that are named in code are links."""
    here, folder = path_of(page.file.src_uri), posixpath.dirname(page.file.src_uri)

    def in_site(match):
        target = posixpath.normpath(posixpath.join(posixpath.dirname(here), match[0]))
        if target.startswith("..") or target.startswith("docs/") and not page.file.src_uri.startswith("repository/"):
            return match[0]
        return posixpath.relpath(page_of(target), folder or ".")

    def title(match):
        """Pages in place of files: what a repository's web view calls method.md is called by its title here."""
        target = REPOSITORY / posixpath.normpath(posixpath.join(posixpath.dirname(here), match[2]))
        first = target.read_text(encoding="utf-8").split("\n", 1)[0] if target.is_file() else ""
        return f"[{first[2:]}]" if first.startswith("# ") else match[0]

    def linked(match):
        target = file_named(match[1])
        return f"[{match[0]}]({posixpath.relpath(page_of(target), folder or '.')})" if target else match[0]

    text = outside_code(markdown, lambda part: LINK.sub(in_site, FILE_AS_TEXT.sub(title, part)))
    text = without_fences(text, lambda line: NAMED_FILE.sub(linked, line))
    return with_anchors(text) if here == "docs/case_file.md" else text


def on_page_content(html, page, config, files):
    """Formulas in LaTeX become MathML, which browsers draw without a script."""

    def mathml(match):
        formula = match[3].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
        return latex2mathml.converter.convert(formula.strip(), display="block" if match[1] == "div" else "inline")

    return FORMULA.sub(mathml, html)


def said(*words):
    """What gridmorph prints; GRIDMORPH names the executable."""
    program = os.environ.get("GRIDMORPH")
    if not program:
        raise PluginError("GRIDMORPH names no gridmorph executable, of whose words pages of the site are made; scripts/docs sets it")
    return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout


def command_line():
    """A page of what gridmorph and its commands say to --help."""
    def wrapped(line):
        indent = 34 if re.match(r"  [-\w]", line) else len(line) - len(line.lstrip())
        return textwrap.fill(line, 84, subsequent_indent=" " * indent, break_on_hyphens=False) if len(line) > 84 and not line.startswith("  gridmorph ") else line

    def ask(*words):
        return "\n".join(wrapped(line.replace(str(REPOSITORY / "docs"), "docs")) for line in said(*words, "--help").rstrip().split("\n"))

    overview = ask()
    listed = overview[overview.index("Subcommands:"):]
    commands = re.findall(r"^  (\w+)  ", listed, re.M)
    text = f"# Command line\n\nWhat `gridmorph --help` and `gridmorph COMMAND --help` print; made from them.\n\n```text\n{overview}\n```\n"
    for command in commands:
        text += f"\n## {command}\n\n```text\n{ask(command)}\n```\n"
    return text
