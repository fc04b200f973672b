#!/usr/bin/env python3
"""report.html in headless Chromium: what a person sees and does, over WebDriver.

usage: browser.py MYOWAVE WORK     pages and screenshots go to WORK
Exit status 77 (skipped) where chromium or chromedriver is missing.
"""
import base64
import json
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path


class Browser:
    """A session of chromedriver; only what is needed of https://www.w3.org/TR/webdriver2/."""

    def __init__(self, width, height):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.driver = subprocess.Popen([shutil.which("chromedriver"), f"--port={port}"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.base = f"http://127.0.0.1:{port}"
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--force-device-scale-factor=1", f"--window-size={width},{height}",
                     f"--user-data-dir={self.profile.name}", "about:blank"]
        wanted = {"browserName": "chrome", "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
                  "goog:chromeOptions": {"args": arguments, "binary": shutil.which("chromium")}}
        for attempt in range(100):
            try:
                urllib.request.urlopen(self.base + "/status", timeout=1).read()
                break
            except OSError:
                time.sleep(0.1)
        session = self.call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self.base += "/session/" + session["sessionId"]

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()) from None

    def script(self, code):
        return self.call("POST", "/execute/sync", {"script": code, "args": []})

    def devtools(self, command, **parameters):
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def element(self, selector):
        found = self.call("POST", "/element", {"using": "css selector", "value": selector})
        return "/element/" + next(iter(found.values()))

    def click(self, selector):
        self.call("POST", self.element(selector) + "/click", {})

    def go(self, uri):
        self.call("POST", "/url", {"url": uri})

    def press(self, selector, key):
        self.call("POST", self.element(selector) + "/value", {"text": key})

    def view(self, width, height):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                      mobile=False)

    def scheme(self, name):
        self.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def whole_page(self, file):
        size = self.devtools("Page.getLayoutMetrics")["cssContentSize"]
        shot = self.devtools("Page.captureScreenshot", captureBeyondViewport=True,
                             clip={"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1})
        file.write_bytes(base64.b64decode(shot["data"]))

    def log(self, kind):
        return self.call("POST", "/se/log", {"type": kind})

    def close(self):
        try:
            self.call("DELETE", "")
        finally:
            self.driver.send_signal(signal.SIGTERM)
            self.driver.wait()
            self.profile.cleanup()


RIGHT_ARROW = "\ue014"
PICTURE = "return document.querySelector('.sheet canvas').toDataURL()"
GROUND = "return getComputedStyle(document.body).backgroundColor"
OVERFLOW = "return document.documentElement.scrollWidth - document.documentElement.clientWidth"


def make_runs(myowave, work):
    """A contracting sheet with a stimulus, and one like it that is rigid."""
    scene = work / "scene.toml"
    scene.write_text("""
[grid]
n = 41
[time]
t_end = 40
[mechanics]
[initial]
type = "broken_front"
[output]
every = 1
fields = true
""")
    evil = work / "<script>alert(1)<img src=x onerror=alert(2)>"
    shutil.rmtree(evil, ignore_errors=True)
    evil.parent.mkdir(parents=True, exist_ok=True)
    rigid = work / "rigid"
    for folder, more in ((evil, []), (rigid, ["--set", "mechanics.on=false"])):
        subprocess.run([myowave, "run", scene, "--out", folder, "--force", "--quiet", *more], check=True)
    # Text of a run that must be escaped.
    summary = json.loads((evil / "summary.json").read_text())
    summary["warnings"] = ["</script><script>document.title = 'owned'</script>"]
    (evil / "summary.json").write_text(json.dumps(summary))
    return evil, rigid


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what)


def check_page(browser, page, work):
    browser.go(page.as_uri())
    first = browser.script(PICTURE)

    browser.script("const s = document.querySelector('.time'); s.value = s.max; s.dispatchEvent(new Event('input'))")
    last = browser.script(PICTURE)
    check(first != last, "the slider moves the picture")
    check("0.400 s" in browser.script("return document.querySelector('.sheet output').textContent"),
          "the last frame is at 40 t.u.")

    browser.script("const s = document.querySelector('.time'); s.value = 5; s.dispatchEvent(new Event('input'))")
    before = browser.script(PICTURE)
    browser.press(".time", RIGHT_ARROW)
    check(browser.script("return document.querySelector('.time').value") == "6", "an arrow key moves the slider")
    check(browser.script(PICTURE) != before, "and the picture with it")

    browser.click(".play")
    check(browser.script("return document.querySelector('.play').getAttribute('aria-label')") == "Pause",
          "the play button becomes a pause button")
    time.sleep(0.6)
    browser.click(".play")
    stopped = browser.script("return document.querySelector('.time').value")
    check(stopped != "6", "play moves the frames")
    time.sleep(0.2)
    check(browser.script("return document.querySelector('.time').value") == stopped, "pause holds them")

    check(browser.script("return document.title") not in ("owned",), "a warning cannot run as a script")
    check("<script>alert(1)<img src=x" in browser.script("return document.querySelector('h1, h2').parentNode.innerText"),
          "markup in a name stays text")
    check(browser.script("return document.querySelectorAll('img[src=x]').length") == 0, "and makes no element")

    plots = browser.script("return [...document.querySelectorAll('.curves')].map(f => "
                           "JSON.parse(f.querySelector('script').textContent)).map(p => [p.x, p.y])")
    check(len(plots) > 4, "there are curves")
    check(any(x["unit"] == "s" for x, y in plots) and any(y["unit"] == "kPa" for x, y in plots), "axes have units")
    check(browser.script("return [...document.querySelectorAll('.curves img')].every(i => i.naturalWidth > 0)"),
          "the picture of each plot is whole")
    if browser.script("return typeof uPlot !== 'undefined'"):
        check(browser.script("return document.querySelectorAll('.curves .uplot canvas').length") > 2, "uPlot draws")
        check(browser.script("return document.querySelectorAll('.curves .u-legend .u-series').length") > 4,
              "with its legends")
    else:
        check(browser.script("return document.querySelectorAll('.curves.drawn').length") == 0,
              "without uPlot the pictures stay")
    check(browser.script("return [...document.querySelectorAll('button, input')].every(e => "
                         "e.getAttribute('aria-label') || e.closest('label'))"), "every control has a name")


def check_looks(browser, work, name):
    browser.view(1200, 900)
    browser.scheme("light")
    light = browser.script(GROUND)
    browser.whole_page(work / f"{name}_light.png")
    browser.scheme("dark")
    check(browser.script(GROUND) != light, "dark mode changes the colours")
    browser.whole_page(work / f"{name}_dark.png")
    browser.scheme("light")
    check(browser.script(OVERFLOW) <= 0, "nothing is wider than the page")
    browser.view(360, 740)
    time.sleep(0.3)
    check(browser.script(OVERFLOW) <= 0, "nor on a narrow screen")
    browser.whole_page(work / f"{name}_narrow.png")
    printed = browser.call("POST", "/print", {})
    (work / f"{name}.pdf").write_bytes(base64.b64decode(printed))
    check(len(printed) > 10_000, "it prints")


def check_logs(browser, page):
    errors = [entry for entry in browser.log("browser") if entry["level"] in ("SEVERE", "WARNING")]
    check(not errors, f"the console is silent {errors or ''}")
    asked = set()
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        parameters = message["params"]
        # The browser's start page requests files too.
        if message["method"] == "Network.requestWillBeSent" and parameters["documentURL"].startswith("file:"):
            asked.add(parameters["request"]["url"][:200])
    check(page.as_uri() in asked, "the log of requests holds the page")
    asked = {url for url in asked if url != page.as_uri() and not url.startswith("data:")}
    check(not asked, f"nothing is asked of the network {asked or ''}")


def main():
    myowave, work = sys.argv[1], Path(sys.argv[2]).resolve()
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        print("skipped: chromium or chromedriver is not installed")
        return 77
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    evil, rigid = make_runs(myowave, work)
    pages = {"one": work / "one" / "report.html", "two": work / "two" / "report.html"}
    subprocess.run([myowave, "report", evil, "--out", pages["one"]], check=True)
    subprocess.run([myowave, "report", evil, rigid, "--out", pages["two"]], check=True)
    browser = Browser(1200, 900)
    try:
        for name, page in pages.items():
            print(f"--- {name}")
            check(page.stat().st_size < 15e6, "the page is below 15 MB")
            check_page(browser, page, work)
            check_looks(browser, work, name)
            check_logs(browser, page)
            browser.view(1200, 900)
    finally:
        browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
