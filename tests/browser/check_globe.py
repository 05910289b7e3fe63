#!/usr/bin/python3
"""Opens a report's globe in headless Chromium and holds its values against the files of the run.

usage: check_globe.py RUN [PICTURES]

Five places of each of several layers must show what netCDF4 reads there, to the step of the layer's codes;
the canvas must show a globe and answer to keys, layers and hands; the console stays free of errors.
"""

import sys
from pathlib import Path

import numpy as np
from netCDF4 import Dataset
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

PLACES = [(12.3, -45.6), (-60.1, 170.2), (80.0, 0.5), (0.2, 99.9), (-33.3, -120.7)]
failures = []


def expect(good, *words):
    if not good:
        failures.append(" ".join(map(str, words)))
        print("FAIL", failures[-1], flush=True)


def browser():
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--enable-unsafe-swiftshader", "--window-size=1280,1000"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(120)
    return driver


def ask(driver, expression):
    """What a promise of the page comes to."""
    return driver.execute_async_script(
        f"const done = arguments[0]; Promise.resolve({expression}).then(done, (error) => done(String(error)))")


def files_of(run):
    """The file of each field as the last stage of the planet left it."""
    found = {}
    for path in sorted(run.glob("0*.nc")):
        if "island" in path.name:
            continue
        with Dataset(path) as file:
            for name, variable in file.variables.items():
                if variable.dimensions == ("lat", "lon"):
                    found[name] = path
    return found


def check_values(driver, run):
    files = files_of(run)
    layers = driver.execute_script("return terraneGlobe.layers")
    expect(len(layers) >= 10, "has only the layers", layers)
    for name in layers:
        if name not in files:
            continue
        with Dataset(files[name]) as file:
            file.set_auto_mask(False)
            latitude, longitude, values = file["lat"][:], file["lon"][:], file[name]
            for north, east in PLACES:
                told = ask(driver, f"terraneGlobe.value('{name}', {north}, {east})")
                row = int(np.abs(latitude - told["latitude"]).argmin())
                column = int(np.abs(longitude - told["longitude"]).argmin())
                expect(abs(told["latitude"] - north) < 1 and abs(told["longitude"] - east) < 1.5, name, "at", told)
                there = float(values[row, column])
                value = np.nan if told["value"] is None else told["value"]
                same = np.isnan(value) if np.isnan(there) or (there == -1 and value != there) else (
                    abs(value - there) <= 0.51 * told["quantum"])
                expect(same, name, "at", north, east, "shows", told["value"], "not", there)


def pixels(driver):
    """How many pixels of the canvas are drawn, and their mean."""
    return driver.execute_async_script("""
      const done = arguments[0], canvas = document.querySelector("#globe canvas");
      terraneGlobe.look(20, 0);
      requestAnimationFrame(() => requestAnimationFrame(() => {
        const copy = document.createElement("canvas"), pen = copy.getContext("2d");
        copy.width = 200; copy.height = 120;
        terraneGlobe.draw();
        pen.drawImage(canvas, 0, 0, 200, 120);
        const bytes = pen.getImageData(0, 0, 200, 120).data;
        let drawn = 0, sum = 0;
        for (let at = 0; at < bytes.length; at += 4) if (bytes[at + 3] > 0) { ++drawn; sum += bytes[at] + bytes[at + 1] + bytes[at + 2]; }
        done([drawn / 24000, sum / 3 / Math.max(1, drawn)]);
      }));""")


def main():
    run = Path(sys.argv[1]).resolve()
    driver = browser()
    driver.get(f"file://{run}/report.html")
    ready = ask(driver, "terraneGlobe.ready.then(() => performance.getEntriesByName('globe-first-frame')[0].startTime)")
    expect(isinstance(ready, (int, float)), "is never ready:", ready)
    check_values(driver, run)
    share, mean = pixels(driver)
    expect(0.2 < share < 0.75, "covers", share, "of the canvas")
    expect(60 < mean < 220, "is as bright as", mean)
    if len(sys.argv) > 2:
        for name in driver.execute_script("return terraneGlobe.layers"):
            ask(driver, f"terraneGlobe.show('{name}')")
            ask(driver, "new Promise((done) => setTimeout(done, 300))")
            driver.save_screenshot(f"{sys.argv[2]}/globe-{name}.png")
    canvas = driver.find_element("css selector", "#globe canvas")
    before = driver.execute_script("return terraneGlobe.view().longitude")
    canvas.send_keys(Keys.ARROW_RIGHT)
    expect(driver.execute_script("return terraneGlobe.view().longitude") != before, "does not turn by a key")
    value = driver.find_element("css selector", "[data-part=value]")
    ActionChains(driver).move_to_element_with_offset(canvas, 10, 20).perform()
    expect("°" in value.text, "tells no place under the cursor:", value.text)
    before = driver.execute_script("return terraneGlobe.view().longitude")
    ActionChains(driver).click_and_hold(canvas).move_by_offset(120, 0).release().perform()
    expect(driver.execute_script("return terraneGlobe.view().longitude") != before, "does not turn by hand")
    errors = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
    expect(not errors, "console:", errors)
    driver.quit()
    size = (run / "report.html").stat().st_size
    expect(size < 15e6, "report.html has", size, "bytes")
    print(f"globe: first frame after {ready:.0f} ms, page of {size / 1e6:.1f} MB, {len(failures)} failures")
    sys.exit(1 if failures else 0)


main()
