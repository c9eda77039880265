# SPDX-License-Identifier: BSD-3-Clause
"""Pages in Chromium without a screen, and images to make pages of."""

import array
import itertools
import math
import random
import struct
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class Browser:
    """Chromium; `gpu`: what it is told about graphics."""

    def __init__(self, chromium, driver, gpu=SOFTWARE, downloads=None):
        options = Options()
        options.binary_location = chromium
        for argument in ["--headless=new", "--no-sandbox", "--hide-scrollbars", "--window-size=1280,940", *gpu]:
            options.add_argument(argument)
        if downloads:
            options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(driver), options=options)
        self.driver.set_script_timeout(60)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def size(self, width, height, ratio=1.0):
        """What the page has, in its own pixels; below 500 as a phone."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": ratio, "mobile": width < 500})

    def prefer(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def open(self, page):
        """Opens a file and waits until it is ready, or says why it is not."""
        self.driver.get(page.resolve().as_uri())
        self.until("window.tegl !== undefined || window.teglError !== undefined")
        return self.run("return window.teglError ?? ''")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, condition, seconds=30):
        end = time.monotonic() + seconds
        while not self.run(f"return {condition}"):
            assert time.monotonic() < end, f"not after {seconds} s: {condition}"
            time.sleep(0.02)

    def element(self, selector):
        return self.driver.find_element("css selector", selector)

    def errors(self):
        """What the page has complained of since the last time."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def write_nrrd(path, sizes, value, more=""):
    """An image of floats, axis 0 fastest; `value` of the index; `more`: lines of the header."""
    values = array.array("f", (value(*reversed(index)) for index in itertools.product(*map(range, reversed(sizes)))))
    header = f"NRRD0004\ntype: float\ndimension: {len(sizes)}\nsizes: {' '.join(map(str, sizes))}\n{more}"
    path.write_bytes((header + "encoding: raw\nendian: little\n\n").encode() + values.tobytes())


def write_scan(path, size=12):
    """A ball off the middle as NIfTI, in mm from the patient's left to the right, back to front, feet to head."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, size, size, size, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 16, 32)  # float
    struct.pack_into("<8f", header, 76, 1, 2, 2, 2, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[123] = 2  # mm
    struct.pack_into("<2h", header, 252, 0, 1)
    for row in range(3):
        struct.pack_into("<4f", header, 280 + 16 * row, *(2.0 * (row == column) for column in range(3)), -11.0)
    header[344:348] = b"n+1\0"
    values = (4 - math.dist((x, y, z), (4, 5, 6)) for z, y, x in itertools.product(range(size), repeat=3))
    path.write_bytes(bytes(header) + array.array("f", values).tobytes())


def write_balls(path, size=16, steps=7, is_backwards=False):
    """Two balls that come together and merge, or backwards; in 4D."""
    middle = (size - 1) / 2

    def value(x, y, z, t):
        away = (t if is_backwards else steps - 1 - t) * 0.75
        return 3.4 - min(math.hypot(x - middle - s * away, y - middle, z - middle) for s in (-1, 1))

    write_nrrd(path, (size, size, size, steps), value)


def write_noise(path, sizes, seed):
    """Few different values, so that many samples equal the isovalue."""
    numbers = random.Random(seed)
    write_nrrd(path, sizes, lambda *_: numbers.randrange(4))
