#!/usr/bin/env python3
"""check_site.py FOLDER: says what is wrong with a built site, a line each: pages, styles and scripts that take something from another host,
links and anchors that lead nowhere, formulas that are still LaTeX. Exit status 1 where there is any."""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADS = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "object": "data", "embed": "src"}
LOADED_LINKS = {"stylesheet", "icon", "preload", "prefetch", "preconnect", "modulepreload", "manifest", "dns-prefetch"}
CODE = {"code", "pre", "script"}
ELSEWHERE = re.compile(r"(?:[a-z][a-z0-9+.-]*:)?//", re.I)
IN_STYLE = re.compile(r"url\(\s*['\"]?([^'\")]+)|@import\s+['\"]([^'\"]+)", re.I)


class Page(HTMLParser):
    """What a page loads, links to and has anchors for."""

    def __init__(self, text):
        super().__init__()
        self.loads, self.links, self.anchors, self.style, self.code, self.raw = [], [], {""}, False, 0, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(value for value in (given.get("id"), given.get("name")) if value)
        if tag in LOADS and given.get(LOADS[tag]):
            self.loads.append(given[LOADS[tag]])
        if tag == "link" and LOADED_LINKS & set((given.get("rel") or "").split()):
            self.loads.append(given.get("href") or "")
        if tag == "a" and given.get("href") is not None:
            self.links.append(given["href"])
        for part in (given.get("srcset") or "").split(","):
            self.loads += part.split()[:1]
        self.loads += in_style(given.get("style") or "")
        self.style = tag == "style"
        self.code += tag in CODE
        if "arithmatex" in (given.get("class") or "").split():
            self.raw.append(f"<{tag}>")

    def handle_endtag(self, tag):
        self.style = self.style and tag != "style"
        self.code -= tag in CODE

    def handle_data(self, data):
        if self.style:
            self.loads += in_style(data)
        elif not self.code and "$$" in data:
            self.raw.append(data.strip()[:40])


def in_style(text):
    """Addresses that a style sheet names; those with their content in them (data:) load nothing."""
    return [a or b for a, b in IN_STYLE.findall(text)]


def problems(site):
    """What is wrong, as lines."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    if not pages:
        yield f"{site}: no pages there"
    for path in sorted(site.rglob("*.css")):
        yield from (f"{path.relative_to(site)}: takes {name} from another host" for name in in_style(path.read_text(encoding="utf-8")) if ELSEWHERE.match(name))
    for path, page in pages.items():
        where = path.relative_to(site)
        yield from (f"{where}: takes {name} from another host" for name in page.loads if ELSEWHERE.match(name))
        yield from (f"{where}: a formula is still LaTeX: {text}" for text in page.raw)
        for link in page.links + page.loads:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or where.name == "404.html":  # what stands in 404.html is shown at any address
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.exists():
                yield f"{where}: {link} leads nowhere"
            elif target in pages and unquote(parts.fragment) not in pages[target].anchors:
                yield f"{where}: {link} names an anchor that is not there"


if __name__ == "__main__":
    found = list(problems(Path(sys.argv[1]).resolve()))
    print("\n".join(found) if found else "no problems found")
    sys.exit(bool(found))
