#!/usr/bin/python3
"""Opens pages in headless Chromium as readers do: light and dark, on a desktop and on a phone.

usage: check_pages.py [--pictures FOLDER] [--site FOLDER] [PAGE.html ...]

A page must write no error to the console, show all its pictures and formulas, not be wider than the
screen, and open a picture in full size when its thumbnail is clicked. PAGEs are opened from the disk;
--site takes all pages of a folder, through a server, on a phone alone, light and dark in turn. --pictures
keeps screenshots. Prints a line per failure and ends with 1 if there was any.
"""

import argparse
import base64
import functools
import http.server
import itertools
import sys
import threading
from pathlib import Path

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.service import Service

SCREENS = {"desktop": (1280, 900, False), "phone": (390, 844, True)}
SCHEMES = ("light", "dark")

# Lazy pictures load when they come into sight; a page's own scripts finish before them.
LOAD_PICTURES = """
const done = arguments[0];
const pictures = [...document.images];
for (const picture of pictures) picture.loading = "eager";
Promise.allSettled(pictures.map((picture) => picture.decode())).then(() =>
  done(pictures.filter((picture) => picture.naturalWidth === 0).map((picture) => picture.src)));
"""
# What sticks out, the outermost element first, unless it scrolls within something.
STICKING_OUT = """
const width = arguments[0];
const scrolls = (node) => node && (["auto", "scroll", "hidden", "clip"].includes(getComputedStyle(node).overflowX)
  && node !== document.body && node !== document.documentElement || scrolls(node.parentElement));
return [...document.body.querySelectorAll("*")]
  .filter((node) => node.getBoundingClientRect().right > width + 0.5 && !scrolls(node.parentElement))
  .slice(0, 3).map((node) => node.outerHTML.slice(0, 90));
"""


def browser():
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    # Root, as continuous integration is, may not open the sandbox; containers have little /dev/shm.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",
                     "--hide-scrollbars", "--force-color-profile=srgb"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def set_screen(driver, screen, scheme):
    width, height, mobile = SCREENS[screen]
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
        "features": [{"name": "prefers-color-scheme", "value": scheme}]})


def console_errors(driver):
    return [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]


def brightness(driver):
    """Of the page's background, 0 to 255."""
    colour = driver.execute_script("""
      const canvas = document.createElement("canvas").getContext("2d");
      canvas.fillStyle = getComputedStyle(document.body).backgroundColor;
      canvas.fillRect(0, 0, 1, 1);
      return [...canvas.getImageData(0, 0, 1, 1).data].slice(0, 3);""")
    return sum(colour) / 3


def thumbnail_failures(driver):
    target = driver.execute_script("""
      const picture = document.querySelector("a > img");
      if (!picture) return null;
      picture.scrollIntoView();
      return picture.parentElement.href;""")
    if target is None:
        return
    driver.execute_script('document.querySelector("a > img").click()')
    if driver.current_url != target:
        yield f"a click on a thumbnail leads to {driver.current_url}, not to {target}"
    elif not driver.execute_script('return document.contentType.startsWith("image/")'):
        yield f"{target} does not open"


def failures_of(driver, url, screen, scheme, picture):
    set_screen(driver, screen, scheme)
    if url.startswith("http"):  # a reader who comes for the first time and has chosen no scheme
        driver.execute_cdp_cmd("Storage.clearDataForOrigin", {"origin": url, "storageTypes": "local_storage"})
    driver.get(url)
    for source in driver.execute_async_script(LOAD_PICTURES):
        yield f"picture {source} does not load"
    width = SCREENS[screen][0]
    wide = driver.execute_script("return document.scrollingElement.scrollWidth")
    if wide > width:
        sticking = driver.execute_script(STICKING_OUT, width)
        yield f"is {wide} pixels wide on a screen of {width}: " + "; ".join(sticking)
    if (brightness(driver) > 127) != (scheme == "light"):
        yield f"its background does not follow the scheme {scheme}"
    for formula in driver.execute_script(
            "return [...document.querySelectorAll('.katex-error')].map((node) => node.textContent)"):
        yield f"formula {formula} cannot be set"
    if picture:
        height = driver.execute_script("return document.scrollingElement.scrollHeight")
        shot = driver.execute_cdp_cmd("Page.captureScreenshot", {
            "captureBeyondViewport": True, "format": "png",
            "clip": {"x": 0, "y": 0, "width": width, "height": min(height, 12000), "scale": 1}})
        picture.write_bytes(base64.b64decode(shot["data"]))
    yield from thumbnail_failures(driver)
    yield from console_errors(driver)


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def do_GET(self):
        if self.path == "/favicon.ico":  # which Chromium asks for beside a picture that stands alone
            self.send_response(204)
            self.end_headers()
        else:
            super().do_GET()


def serve(folder):
    handler = functools.partial(QuietHandler, directory=str(folder))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}"


def visits(options):
    """(name, URL, screen, scheme) of all that is to be opened."""
    everywhere = list(itertools.product(SCREENS, SCHEMES))
    for page in options.pages:
        for screen, scheme in everywhere:
            yield f"{page.parent.name}-{page.stem}", page.resolve().as_uri(), screen, scheme
    if options.site:
        address = serve(options.site)
        pages = sorted(path for path in options.site.rglob("*.html") if "api" not in path.parts)
        for number, page in enumerate(pages):
            name = page.relative_to(options.site).as_posix()
            yield name.replace("/", "-"), f"{address}/{name}", "phone", SCHEMES[number % 2]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--site", type=Path)
    parser.add_argument("pages", nargs="*", type=Path)
    options = parser.parse_args()
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    failed = opened = 0
    driver = browser()
    try:
        for name, url, screen, scheme in visits(options):
            picture = options.pictures and options.pictures / f"{name}-{screen}-{scheme}.png"
            opened += 1
            try:
                failures = list(failures_of(driver, url, screen, scheme, picture))
            except WebDriverException as error:
                failures = [error.msg]
            for words in failures:
                failed += 1
                print(f"{name}, {screen}, {scheme}: {words}", flush=True)
    finally:
        driver.quit()
    print(f"{opened} pages opened, {failed} failures")
    sys.exit(1 if failed or not opened else 0)


main()
