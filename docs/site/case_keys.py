"""Keys of case files, read from the tables of docs/case_file.md, which scripts/case-file-tables makes and a test holds equal to what
the reader knows: an anchor for each of them, an index of all, and the reference that `gridmorph keys` gives."""
import re

OPEN, CLOSE = re.compile(r"<!-- keys: (.+) -->"), "<!-- end of keys -->"
ROW = re.compile(r"^\| `([^`]+)` \| ((?:\\\||[^|])*) \| ((?:\\\||[^|])*) \| ((?:\\\||[^|])*) \|")


def anchor(table, key):
    """The anchor of a key's row: "key-volume-law"."""
    return "key-" + re.sub(r"\W+", "-", f"{table} {key}").strip("-")


def rows(text):
    """(line, table, key, type, unit, default) of each row of the tables of keys."""
    table = None
    for number, line in enumerate(text.split("\n")):
        opened = OPEN.match(line)
        if opened:
            table = opened[1]
        elif line == CLOSE:
            table = None
        elif table:
            row = ROW.match(line)
            if row:
                yield (number, table, *(cell.strip() for cell in row.groups()))


def with_anchors(text):
    """The page with an anchor at each key."""
    lines = text.split("\n")
    for number, table, key, *_ in rows(text):
        lines[number] = lines[number].replace(f"| `{key}` |", f'| <a id="{anchor(table, key)}"></a>`{key}` |', 1)
    return "\n".join(lines)


def place(table):
    """Where a key stands, as a case file has it: "motion rigid rotation" is `[[motion]]` rule `rigid`, `rotation`."""
    words = table.split()
    if table == "top level":
        return "top level"
    if words[0] == "motion" and len(words) > 1:
        return f"`[[motion]]`, rule `{words[1]}`" + "".join(f", `{word}`" for word in words[2:])
    head = f"[[{words[0]}]]" if words[0] in ("motion", "region", "clearance") else f"[{words[0]}]"
    return f"`{head}`" + "".join(f", `{word}`" for word in words[1:])


def reference_page(keys):
    """All keys, table by table, as the reader of case files describes them: keys are those of `gridmorph keys --json`."""
    lines = ["# Reference of keys", "",
             f"All {len(keys)} keys of case files, table by table, from the program: this page is `gridmorph keys`, which takes them from the list that the "
             "reader's own messages are made of. [Case files](case_file.md) has the same keys with examples and more to say of each, and an "
             "[index](case_keys.md) has them by name. All three are made from one list.", ""]
    last = None
    for key in keys:
        if key["table"] != last:
            last = key["table"]
            title = "Top level" if last == "top level" else place(last).replace("`", "")
            lines += ["", f"## {title}", "", "| key | type | unit | default | what it is |", "| --- | --- | --- | --- | --- |"]
        cells = (key[name].replace("|", "\\|") for name in ("type", "unit", "default", "meaning"))
        lines.append(f"| [`{key['key']}`](case_file.md#{anchor(last, key['key'])}) | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def index_page(text):
    """An index of all keys, by name."""
    keys = sorted((key.lower(), table, key, *rest) for _, table, key, *rest in rows(text))
    lines = ["# Index of keys", "",
             f"All {len(keys)} keys of case files by name; made from the tables of [case files](case_file.md), which say what each means.", "",
             "| key | where | type | unit | default |", "| --- | --- | --- | --- | --- |"]
    lines += [f"| [`{key}`](case_file.md#{anchor(table, key)}) | {place(table)} | {kind} | {unit} | {initial} |"
              for _, table, key, kind, unit, initial in keys]
    return "\n".join(lines) + "\n"
