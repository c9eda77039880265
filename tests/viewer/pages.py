# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of pages share: the program, a browser, pictures and labels. Arguments: as those of viewer_test.py."""

import base64
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

from browser import Browser, write_balls

TEGL, CHROMIUM, CHROMEDRIVER, OCEAN = sys.argv[1:5]


def tegl(*arguments):
    done = subprocess.run([TEGL, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def count_of_cut(contour, t, folder):
    """Triangles of the library's cut; at the very ends, beyond which there is no contour, as well."""
    return json.loads(tegl("slice", contour, "--at", f"t={t!r}", "-o", folder / "cut.ply", "--no-check", "--json"))["simplices"]


def pixels(png):
    """Rows of pixels of three numbers, as integers that can be subtracted."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


# Labels that are seen: their texts, and which of them (and the legend) overlap, or the outline of the box.
LABELS = """
const { stage } = tegl.app;
stage.camera.updateMatrixWorld();
stage.placeLabels();
const frame = stage.canvas.getBoundingClientRect();
const labels = [...document.querySelectorAll('.axis-label')].filter((label) => label.style.visibility !== 'hidden');
const box = (element) => { const b = element.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; };
const boxes = [...labels, document.getElementById('legend')].map(box).filter((b) => b[2] > b[0]);
const wrong = [];
boxes.forEach((a, i) => boxes.slice(0, i).forEach((b, j) => {
  if (Math.min(a[2], b[2]) > Math.max(a[0], b[0]) && Math.min(a[3], b[3]) > Math.max(a[1], b[1]))
    wrong.push(`${labels[j].textContent} / ${labels[i]?.textContent ?? 'legend'}`);
}));
const half = [-0.5, 0.5];
const corners = half.flatMap((x) => half.flatMap((y) => half.map((z) => stage.onScreen([x, y, z]))))
  .map(({ x, y }) => [x + frame.left, y + frame.top]);
for (const [i, label] of labels.entries()) {
  const b = boxes[i];
  const rectangle = [[b[0], b[1]], [b[2], b[1]], [b[2], b[3]], [b[0], b[3]]];
  // Apart if there is a direction in which they are: across a side of one of them.
  const directions = [[1, 0], [0, 1]];
  corners.forEach((p, k) => corners.slice(0, k).forEach((q) => directions.push([p[1] - q[1], q[0] - p[0]])));
  const isApart = directions.some(([x, y]) => {
    const length = Math.hypot(x, y);
    if (length < 1e-6) return false;
    const range = (points) => { const at = points.map((p) => (p[0] * x + p[1] * y) / length); return [Math.min(...at), Math.max(...at)]; };
    const [one, other] = [range(rectangle), range(corners)];
    return one[1] < other[0] + 0.7 || other[1] < one[0] + 0.7;
  });
  if (!isApart) wrong.push(`${label.textContent} / box`);
  if (b[0] < frame.left - 0.5 || b[2] > frame.right + 0.5 || b[1] < frame.top - 0.5 || b[3] > frame.bottom + 0.5)
    wrong.push(`${label.textContent} / border`);
}
return { texts: labels.map((label) => label.textContent), wrong };
"""


class Pages(unittest.TestCase):
    """A browser, a page of two balls, and what its tests share."""

    @classmethod
    def setUpClass(cls):
        cls.keep = tempfile.TemporaryDirectory()
        cls.folder = folder = pathlib.Path(cls.keep.name)
        write_balls(folder / "balls.nrrd")
        tegl("contour", folder / "balls.nrrd", "--iso", 0, "--normals", "-o", folder / "balls.vtkhdf", "-q")
        tegl("view", folder / "balls.vtkhdf", "-o", folder / "balls.html", "-q")
        cls.downloads = folder / "downloads"
        cls.downloads.mkdir()
        cls.browser = Browser(CHROMIUM, CHROMEDRIVER, downloads=cls.downloads)
        cls.browser.size(800, 480)

    @classmethod
    def tearDownClass(cls):
        cls.browser.driver.quit()
        cls.keep.cleanup()

    def setUp(self):
        self.browser.size(800, 480)
        self.browser.prefer("light")
        self.browser.errors()

    def tearDown(self):
        self.assertEqual(self.browser.errors(), [])

    def open(self, name="balls.html"):
        self.assertEqual(self.browser.open(self.folder / name), "")
        return self.browser

    def picture(self):
        """Pixels of the canvas, drawn anew, without labels and frames."""
        self.browser.run("document.getElementById('box').checked = false; tegl.app.stage.box.visible = false")
        url = self.browser.run("tegl.draw(); return document.getElementById('canvas').toDataURL()")
        return pixels(base64.b64decode(url.split(",")[1]))

    def drawn(self, picture):
        """How many pixels are not of the ground, which the corner has."""
        return (picture != picture[0, 0]).any(axis=2).sum()

    def different(self, one, other):
        return (one != other).any(axis=2).sum()

    def same_counts(self, name, iso, times, *options):
        contour = self.folder / f"{name}.vtkhdf"
        tegl("contour", self.folder / f"{name}.nrrd", "--iso", iso, *options, "-o", contour, "-q")
        tegl("view", contour, "-o", self.folder / f"{name}.html", "-q")
        browser = self.open(f"{name}.html")
        counts = [(t, browser.run("tegl.time = arguments[0]; return tegl.count()", t)) for t in times]
        self.assertEqual(counts, [(t, count_of_cut(contour, t, self.folder)) for t in times])

    def view(self, name, *arguments):
        tegl("view", *arguments, "-o", self.folder / f"{name}.html", "-q")
        return self.open(f"{name}.html")
