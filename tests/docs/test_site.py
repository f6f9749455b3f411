"""Tests of docs/site: that faults of a site are found, and that the index has every key of case files."""
import sys
import tempfile
import unittest
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
sys.path.insert(0, str(DOCS / "site"))
from case_keys import anchor, index_page, reference_page, rows, with_anchors  # noqa: E402
from check_site import problems  # noqa: E402
from named_files import NAMED_FILE, file_named  # noqa: E402

PAGE = '<html><head><link rel="stylesheet" href="style.css"><script src="search.js"></script></head><body>{}<h1 id="top">A</h1></body></html>'


class FaultsOfASite(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.site = Path(self.folder.name)
        self.write("style.css", "a { background: url(data:image/png;base64,AAAA) }")
        self.write("search.js", "")
        self.write("other.html", PAGE.format(""))
        self.body('<a href="other.html#top">b</a><a href="https://example.org">c</a><a href="#top">d</a>')

    def write(self, name, text):
        (self.site / name).write_text(text, encoding="utf-8")

    def body(self, text):
        self.write("index.html", PAGE.format(text))

    def found(self):
        return list(problems(self.site))

    def test_a_sound_site_has_none(self):
        self.assertEqual(self.found(), [])

    def test_what_pages_load_from_other_hosts_is_found(self):
        loads = ('<script src="https://cdn.example/a.js"></script>', '<img src="//example/a.png">', '<img src="a" srcset="http://example/b.png 2x">',
                 '<link rel="stylesheet" href="http://fonts.example/f.css">', '<iframe src="https://example/"></iframe>',
                 '<p style="background: url(https://example/a.png)"></p>', "<style>@import 'https://example/a.css';</style>")
        self.write("a", "")
        for load in loads:
            with self.subTest(load=load):
                self.body(load)
                self.assertTrue(any("another host" in line for line in self.found()), self.found())

    def test_what_styles_load_from_other_hosts_is_found(self):
        self.write("style.css", "@font-face { src: url('https://fonts.example/f.woff2') }")
        self.assertEqual(len(self.found()), 1)

    def test_links_and_anchors_that_lead_nowhere_are_found(self):
        self.body('<a href="gone.html">b</a><a href="other.html#gone">c</a><a href="#gone">d</a><img src="gone.png">')
        self.assertEqual(len(self.found()), 4, self.found())

    def test_formulas_that_are_still_latex_are_found(self):
        self.body('<span class="arithmatex">\\(a\\)</span><p>$$ b $$</p><code>$$</code>')
        self.assertEqual(len(self.found()), 2)

    def test_an_empty_folder_is_no_site(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(len(list(problems(Path(empty)))), 1)


class KeysOfCaseFiles(unittest.TestCase):
    text = (DOCS / "case_file.md").read_text(encoding="utf-8")

    def test_the_index_has_every_row_of_the_tables(self):
        inside, count = False, 0
        for line in self.text.split("\n"):
            inside = line.startswith("<!-- keys: ") or inside and line != "<!-- end of keys -->"
            count += inside and line.startswith("| `")
        self.assertGreater(count, 140)
        self.assertEqual(index_page(self.text).count("\n| [`"), count)

    def test_each_entry_leads_to_an_anchor_of_its_own(self):
        anchors = [anchor(table, key) for _, table, key, *_ in rows(self.text)]
        self.assertEqual(len(anchors), len(set(anchors)))
        page, index = with_anchors(self.text), index_page(self.text)
        for name in anchors:
            self.assertEqual(page.count(f'<a id="{name}">'), 1, name)
            self.assertEqual(index.count(f"(case_file.md#{name})"), 1, name)

    def test_the_reference_has_a_part_per_table_and_leads_to_the_rows(self):
        keys = [{"table": table, "key": key, "type": kind, "unit": unit, "default": initial, "meaning": "a | b"}
                for _, table, key, kind, unit, initial in rows(self.text)]
        page = reference_page(keys)
        self.assertEqual(page.count("\n## "), len({key["table"] for key in keys}))
        for key in keys:
            self.assertEqual(page.count(f"(case_file.md#{anchor(key['table'], key['key'])})"), 1, key)
        self.assertEqual(page.count("| a \\| b |"), len(keys))


class PagesOfAlgorithms(unittest.TestCase):
    pages = sorted(path for path in (DOCS / "algorithms").glob("*.md") if path.name != "index.md")

    def test_each_has_a_formula_or_rule_a_source_and_facts(self):
        self.assertGreater(len(self.pages), 10)
        for page in self.pages:
            text = page.read_text(encoding="utf-8")
            with self.subTest(page=page.name):
                self.assertRegex(text, r"\n## (Formula|Rule|Steps)\n")
                self.assertIn("\n## Source\n", text)
                for fact in ("in", "out", "cost", "code", "test", "benchmark"):
                    self.assertEqual(text.count(f"\n| {fact} | "), 1, fact)

    def test_files_that_they_name_are_there(self):
        named = {name for page in self.pages for name in NAMED_FILE.findall(page.read_text(encoding="utf-8"))}
        self.assertGreater(len(named), 100)
        self.assertEqual([name for name in sorted(named) if file_named(name) is None], [])

    def test_each_is_in_the_list_and_has_its_place(self):
        index = (DOCS / "algorithms/index.md").read_text(encoding="utf-8")
        places = (DOCS / "site/mkdocs.yml").read_text(encoding="utf-8")
        for page in self.pages:
            self.assertEqual(index.count(f"]({page.name})"), 1, page.name)
            self.assertEqual(places.count(f"- algorithms/{page.name}\n"), 1, page.name)


class PagesForDevelopers(unittest.TestCase):
    pages = sorted(path for folder in ("howto", "notes") for path in (DOCS / folder).glob("*.md"))

    def test_files_that_they_name_are_there(self):
        for page in self.pages:
            named = set(NAMED_FILE.findall(page.read_text(encoding="utf-8")))
            self.assertEqual([name for name in sorted(named) if file_named(name) is None], [], page.name)

    def test_each_is_linked_and_has_its_place(self):
        notes = (DOCS / "notes/index.md").read_text(encoding="utf-8")
        contributing = (DOCS.parent / "CONTRIBUTING.md").read_text(encoding="utf-8")
        places = (DOCS / "site/mkdocs.yml").read_text(encoding="utf-8")
        for page in self.pages:
            name = page.relative_to(DOCS).as_posix()
            linked = name == "notes/index.md" or f"]({page.name})" in notes or f"](docs/{name})" in contributing
            self.assertTrue(linked, name)
            self.assertEqual(places.count(f"- {name}\n"), 1, name)


if __name__ == "__main__":
    unittest.main()
