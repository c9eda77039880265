#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Frames per second of pages of `tegl view`, in the Chromium of this machine.

    viewer_frames.py PAGE... [WIDTH HEIGHT] [CHROMIUM OPTION...]
    viewer_frames.py --tegl=PROGRAM... [WIDTH HEIGHT] [CHROMIUM OPTION...]

The second form makes its pages itself, by each of the programs (one before a change and one after, say): a gyroid that
drifts, as two million tetrahedra in 2, 3 and 24 steps. In two steps nearly all of them are cut at any time.

Without options Chromium draws as it would for a user; on a server with a graphics card and no screen try
--use-angle=vulkan --enable-features=Vulkan --ignore-gpu-blocklist; --use-angle=swiftshader
--enable-unsafe-swiftshader draws by the processor. Each frame is at another time, and is waited for until it is
drawn, so the limit of the screen does not count; the camera is as far away in all. The pages take turns, three times:
each time up to 40 frames, or as many as 5 seconds take. Prints what draws, and for each page JSON of what a frame takes:
milliseconds (median, of the best turn) for the script, for all until the picture is there, and for the points alone,
without what is between them; how many tetrahedra are drawn, in how many calls, and what share of them is cut.
`than_first`: how many times as fast as the first page (of the same image), the frame and the points.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/viewer"))
from browser import Browser  # noqa: E402

TURNS = 3  # each page so often, in turn
IMAGES = [(2, 100, 6), (3, 72, 6), (24, 32, 3)]  # steps, samples along each axis, periods

MEASURE = """
const { stage, inTime } = tegl.app;
const gl = stage.renderer.getContext();
const pixel = new Uint8Array(4);
const [first, last] = tegl.range;
stage.camera.position.setLength(6);
stage.controls.update();
function frames(most) {
  const script = [], whole = [];
  const until = performance.now() + 5000;
  for (let i = -1; i < most && (i < 1 || performance.now() < until); ++i) {
    const start = performance.now();
    tegl.time = first + (last - first) * (((i + 2) * 0.6180339887) % 1);  // spread, however many there are
    tegl.draw();
    const issued = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    if (i < 0) continue;
    script.push(issued - start);
    whole.push(performance.now() - start);
  }
  const middle = (list) => +[...list].sort((a, b) => a - b)[Math.floor(0.5 * (list.length - 1))].toFixed(2);
  return { frames: whole.length, script_ms: middle(script), frame_ms: middle(whole) };
}
const result = frames(40);
gl.enable(gl.RASTERIZER_DISCARD);
result.points_ms = frames(40).frame_ms;
gl.disable(gl.RASTERIZER_DISCARD);
let cut = 0, looked = 0;
for (const { cuts, level } of inTime)
  for (const [from, to] of cuts.touched(level))
    for (let s = from; s < to; ++s, ++looked) {
      let high = 0;
      for (let k = 0; k < 4; ++k) high += cuts.keys[cuts.simplices[4 * s + k]] >= level.threshold;
      cut += high > 0 && high < 4;
    }
return { ...result, tetrahedra: inTime.reduce((sum, layer) => sum + layer.description.simplices, 0),
  drawn_tetrahedra: looked, cut_share: +(cut / looked).toFixed(3), triangles: inTime.reduce((sum, layer) => sum + layer.quickCount(), 0),
  draw_calls: stage.renderer.info.render.calls };
"""
RENDERER = """
const gl = tegl.app.stage.renderer.getContext();
const info = gl.getExtension('WEBGL_debug_renderer_info');
return { renderer: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'unknown',
  canvas: [gl.drawingBufferWidth, gl.drawingBufferHeight] };
"""


def write_gyroid(path, steps, size, periods):
    """A field that drifts by a fifth of a sample in a step, in float."""
    places = np.linspace(0, 2 * math.pi * periods, size, dtype=np.float32)
    with open(path, "wb") as file:
        file.write(f"NRRD0004\ntype: float\ndimension: 4\nsizes: {size} {size} {size} {steps}\n"
                   "encoding: raw\nendian: little\n\n".encode())
        for step in range(steps):
            shift = 0.11 * step
            x, y, z = places + shift, (places + 0.7 * shift)[:, None], (places - 0.4 * shift)[:, None, None]
            file.write((np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)).astype("<f4").tobytes())


def made_pages(programs, folder):
    """(image, page), the pages of one image one after the other."""
    pages = []
    for steps, size, periods in IMAGES:
        image = folder / f"gyroid{steps}.nrrd"
        write_gyroid(image, steps, size, periods)
        for i, program in enumerate(programs):
            page = folder / f"gyroid{steps}_{i}.html"
            subprocess.run([program, "view", image, "--iso", "0.1", "--limit", "0", "-o", page, "-q"], check=True)
            pages.append((f"{steps} steps", page))
    return pages


def measure(browser, page):
    wrong = browser.open(page)
    if wrong:
        sys.exit(f"{page}: {wrong}")
    if browser.run("return tegl.app.inTime.length") == 0:
        sys.exit(f"{page}: no 4D contour; expected one")
    browser.run("tegl.app.togglePanel(false)")
    return browser.run(MEASURE)


def main():
    programs = [argument.split("=", 1)[1] for argument in sys.argv[1:] if argument.startswith("--tegl=")]
    options = [argument for argument in sys.argv[1:] if argument.startswith("-") and not argument.startswith("--tegl=")]
    size = [int(argument) for argument in sys.argv[1:] if argument.isdigit()] or [1280, 800]
    with tempfile.TemporaryDirectory() as name, Browser(shutil.which("chromium"), shutil.which("chromedriver"),
                                                        gpu=options) as browser:
        pages = [("given", pathlib.Path(argument)) for argument in sys.argv[1:] if argument.endswith(".html")]
        pages += made_pages(programs, pathlib.Path(name))
        if not pages:
            sys.exit(__doc__)
        browser.size(*size)
        browser.driver.set_script_timeout(240)
        turns = [[measure(browser, page) for _, page in pages] for _ in range(TURNS)]
        print(json.dumps(browser.run(RENDERER)))
        first = {}
        for i, (image, page) in enumerate(pages):
            best = min((turn[i] for turn in turns), key=lambda result: result["frame_ms"])
            for key in ("script_ms", "points_ms"):
                best[key] = min(turn[i][key] for turn in turns)
            before = first.setdefault(image, best)
            best["than_first"] = [round(before[key] / best[key], 2) for key in ("frame_ms", "points_ms")]
            print(json.dumps({"image": image, "page": page.name, **best}))


if __name__ == "__main__":
    main()
