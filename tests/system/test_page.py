#!/usr/bin/python3
"""Report pages in a browser: no errors, no requests, nothing wider than the screen; light and dark, wide and narrow, on paper.

  test_page.py GRIDMORPH                     makes pages (a passage, a ball of elements, a sequence) and looks at them
  test_page.py --look page.html --out FOLDER pictures of a page that is there, as a browser shows it

Skipped (status 77) where there is no Chromium. The browser is spoken to over a pipe, in the protocol of its own tools.
"""
import argparse
import base64
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

GRIDMORPH = None
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
VOID = {"meta", "link", "img", "br", "input", "path", "rect", "circle"}


def browser_program():
    return next(filter(None, map(shutil.which, BROWSERS)), None)


class Browser:
    """A headless browser with one page."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="gridmorph-browser-")
        (to_read, self.to_browser), (self.from_browser, to_write) = os.pipe(), os.pipe()

        def pipes():  # the browser reads from 3 and writes to 4
            os.dup2(to_read, 100)
            os.dup2(to_write, 101)
            os.dup2(100, 3)
            os.dup2(101, 4)

        self.process = subprocess.Popen(
            [browser_program(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--hide-scrollbars", f"--user-data-dir={self.folder}", "--remote-debugging-pipe",
             "about:blank"],
            preexec_fn=pipes, close_fds=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.rest, self.number, self.events, self.session = b"", 0, [], None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def close(self):
        for pipe in (self.to_browser, self.from_browser):
            os.close(pipe)
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def message(self):
        while b"\0" not in self.rest:
            more = os.read(self.from_browser, 1 << 20)
            if not more:
                raise RuntimeError("the browser has gone")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        data = json.dumps(request).encode() + b"\0"
        while data:
            data = data[os.write(self.to_browser, data):]
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def wait(self, event):
        while not any(e.get("method") == event for e in self.events):
            self.events.append(self.message())

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"])
        return result["result"].get("value")

    def open(self, path, width, scheme, height=900):
        self.events.clear()
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        self.wait("Page.loadEventFired")

    def complaints(self):
        """What the page wrote to the console, threw or asked for."""
        out = []
        for event in self.events:
            parameters = event.get("params", {})
            if event.get("method") == "Runtime.exceptionThrown":
                out.append("exception: " + str(parameters["exceptionDetails"]))
            elif event.get("method") == "Log.entryAdded":
                out.append("log: " + parameters["entry"]["text"])
            elif event.get("method") == "Runtime.consoleAPICalled":
                out.append("console: " + str(parameters["args"]))
            elif event.get("method") == "Network.requestWillBeSent":
                url = parameters["request"]["url"]
                if not url.startswith(("file://", "data:")) or url.startswith("file://") and not url.endswith(".html"):
                    out.append("request: " + url)
        return out

    def too_wide(self):
        """Elements that stick out of the page to the right, but for those in boxes that scroll."""
        return self.evaluate("""(() => {
          const wide = document.documentElement.clientWidth, out = [];
          if (document.documentElement.scrollWidth > wide) out.push("page " + document.documentElement.scrollWidth);
          for (const e of document.querySelectorAll("body *")) {
            if (e.closest(".scroll, .graph, svg, pre") && !e.matches(".scroll, .graph, svg, pre")) continue;
            if (e.closest(".graph, .scroll") && e.matches("svg")) continue;
            const box = e.getBoundingClientRect();
            if (box.width > 0 && box.right > wide + 1) out.push(e.tagName + "." + e.className + " " + box.right);
          }
          return out;
        })()""")

    def screenshot(self, path):
        height = self.evaluate("document.documentElement.scrollHeight")
        width = self.evaluate("document.documentElement.clientWidth")
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                         clip={"x": 0, "y": 0, "width": width, "height": min(height, 16000), "scale": 1})["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def pdf(self):
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"])


class Tags(html.parser.HTMLParser):
    """Every tag that is opened is closed, in order; what is asked for from elsewhere; ids and links to them."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.problems, self.sources, self.ids, self.links = [], [], [], set(), []
        self.feed(text)
        self.close()
        if self.open:
            self.problems.append(f"left open: {self.open}")

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        self.note(dict(attrs))

    def handle_startendtag(self, tag, attrs):
        self.note(dict(attrs))

    def note(self, attrs):
        for key in ("src", "href", "xlink:href", "srcset", "action", "data"):
            if attrs.get(key, "").startswith("#"):
                self.links.append(attrs[key][1:])
            elif key in attrs:
                self.sources.append(attrs[key][:40])
        if "id" in attrs:
            if attrs["id"] in self.ids:
                self.problems.append(f"id {attrs['id']} twice")
            self.ids.add(attrs["id"])

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        if not self.open or self.open[-1] != tag:
            self.problems.append(f"</{tag}> closes {self.open[-1:]} in line {self.getpos()[0]}")
        else:
            self.open.pop()


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="gridmorph-page-")

        def run(*words, status=0):
            result = subprocess.run([GRIDMORPH, "--quiet", *words], cwd=cls.folder, capture_output=True, text=True, check=False)
            assert result.returncode in (status, 1), result.stderr
        run("demo", "passage", "--nodes", "10000", "--motion", "rotation", "-d", "passage")
        run("morph", "passage/rotation.toml", "--html", "passage.html", "--report", "passage.json", "-o", "moved.cgns")
        run("demo", "ball", "--elements", "50000", "-d", "ball")
        case = next(n for n in os.listdir(os.path.join(cls.folder, "ball")) if n.endswith(".toml"))
        run("morph", "ball/" + case, "--html", "ball.html", "--report", "ball.json", "-o", "moved_ball.cgns")
        text = read(os.path.join(cls.folder, "passage/rotation.toml"))
        text = re.sub(r'(?m)^output *=.*\n', "", text, count=1)
        text = re.sub(r'(?m)^(file *= *"rotation.csv")', r'\1\namplitude = "sin(2 * pi * t)"', text, count=1)
        with open(os.path.join(cls.folder, "passage/steps.toml"), "w", encoding="utf-8") as file:
            file.write(text + '\n[sequence]\nsteps = 5\noutput = "steps.cgns"\n')
        run("morph", "passage/steps.toml", "--html", "steps.html", "--report", "steps.json")
        cls.pages = [os.path.join(cls.folder, name) for name in ("passage.html", "ball.html", "steps.html")]
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_are_well_formed_and_stand_alone(self):
        for page in self.pages:
            tags = Tags(read(page))
            self.assertEqual(tags.problems, [], page)
            self.assertTrue(all(s.startswith("data:") for s in tags.sources), tags.sources)
            self.assertEqual([link for link in tags.links if link not in tags.ids], [], page)

    def test_say_nothing_to_the_console_and_ask_for_nothing(self):
        for page in self.pages:
            self.browser.open(page, 1280, "light")
            self.assertEqual(self.browser.complaints(), [], page)

    def test_fit_phones_and_screens_in_light_and_dark(self):
        for page in self.pages:
            for width in (360, 1280):
                for scheme in ("light", "dark"):
                    self.browser.open(page, width, scheme)
                    self.assertEqual(self.browser.too_wide(), [], f"{page} {width} {scheme}")
            paper = self.browser.evaluate("getComputedStyle(document.body).backgroundColor")
            self.assertNotEqual(paper, "rgb(255, 255, 255)", "dark is dark")

    def test_show_every_picture(self):
        for page in self.pages:
            self.browser.open(page, 1280, "light")
            broken = self.browser.evaluate("[...document.images].filter(i => !(i.complete && i.naturalWidth > 0)).length")
            self.assertEqual(broken, 0, page)
            self.assertGreater(self.browser.evaluate("document.images.length"), 2)

    def test_print(self):
        for page in self.pages:
            self.browser.open(page, 1280, "dark")
            self.assertTrue(self.browser.pdf().startswith(b"%PDF-"))

    def test_step_through_sequences(self):
        self.browser.open(self.pages[2], 1280, "light")
        shown = "[...document.querySelectorAll('.steps figure')].filter(f => f.offsetHeight > 0).length"
        self.assertEqual(self.browser.evaluate(shown), 1)
        self.browser.evaluate("{ const s = document.querySelector('.slider input'); s.value = 0; s.dispatchEvent(new Event('input')); }")
        self.assertEqual(self.browser.evaluate("document.querySelectorAll('.steps figure')[0].offsetHeight > 0"), True)
        self.assertEqual(self.browser.evaluate(shown), 1)
        self.browser.call("Emulation.setScriptExecutionDisabled", value=True)
        self.browser.open(self.pages[2], 1280, "light")
        self.browser.call("Emulation.setScriptExecutionDisabled", value=False)
        self.assertEqual(self.browser.evaluate(shown), self.browser.evaluate("document.querySelectorAll('.steps figure').length"))


def look(pages, out):
    os.makedirs(out, exist_ok=True)
    browser = Browser()
    for page in pages:
        name = os.path.splitext(os.path.basename(page))[0]
        for width in (1280, 360):
            for scheme in ("light", "dark"):
                browser.open(page, width, scheme)
                for what in browser.complaints() + browser.too_wide():
                    print(f"{name} {width} {scheme}: {what}")
                browser.screenshot(os.path.join(out, f"{name}_{width}_{scheme}.png"))
        with open(os.path.join(out, name + ".pdf"), "wb") as file:
            file.write(browser.pdf())
    browser.close()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gridmorph", nargs="?", help="the command")
    parser.add_argument("--look", nargs="+", metavar="PAGE", help="pictures of pages that are there")
    parser.add_argument("--out", default="pages", help="folder for them (default: pages)")
    options = parser.parse_args()
    if browser_program() is None:
        print("skipped: no Chromium (Debian: apt-get install chromium)")
        sys.exit(77)
    if options.look:
        look(options.look, options.out)
        sys.exit(0)
    GRIDMORPH = os.path.abspath(options.gridmorph)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
