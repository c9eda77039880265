#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Frames per second of a page of `tegl view`, in the Chromium of this machine.

    viewer_frames.py PAGE [WIDTH HEIGHT] [CHROMIUM OPTION...]

Without options Chromium draws as it would for a user; on a server with a graphics card and no screen try
--use-angle=vulkan --enable-features=Vulkan --ignore-gpu-blocklist; --use-angle=swiftshader
--enable-unsafe-swiftshader draws by the processor. Each frame is at another time, and is waited for until it is
drawn, so the limit of the screen does not count: up to 200 of them, or as many as 20 seconds take. Prints what draws, and JSON of what a frame
takes: milliseconds (median and the slowest of twenty) for the script, and for all until the picture is there.
"""

import json
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/viewer"))
from browser import Browser  # noqa: E402

MEASURE = """
const gl = tegl.app.stage.renderer.getContext();
const info = gl.getExtension('WEBGL_debug_renderer_info');
const pixel = new Uint8Array(4);
const [first, last] = tegl.range;
const script = [], whole = [], drawn = [], cut = [];
const until = performance.now() + 20000;
for (let i = -3; i < arguments[0] && (i < 5 || performance.now() < until); ++i) {
  const start = performance.now();
  tegl.time = first + (last - first) * (((i + 3) * 0.6180339887) % 1);  // spread, however many there are
  const layers = tegl.draw();
  const issued = performance.now();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  const end = performance.now();
  if (i < 0) continue;
  script.push(issued - start);
  whole.push(end - start);
  drawn.push(layers.reduce((sum, layer) => sum + layer.tetrahedra, 0));
  cut.push(tegl.app.inTime.reduce((sum, layer) => sum + layer.quickCount(), 0));
}
const at = (list, share) => [...list].sort((a, b) => a - b)[Math.floor(share * (list.length - 1))];
const both = (list) => ({ median: +at(list, 0.5).toFixed(2), slow: +at(list, 0.95).toFixed(2) });
return { renderer: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'unknown',
  canvas: [gl.drawingBufferWidth, gl.drawingBufferHeight], frames: whole.length,
  tetrahedra: tegl.app.inTime.reduce((sum, layer) => sum + layer.description.simplices, 0),
  drawn_tetrahedra: both(drawn), triangles: both(cut), script_ms: both(script), frame_ms: both(whole),
  frames_per_second: +(1000 / at(whole, 0.5)).toFixed(1) };
"""


def main():
    page = pathlib.Path(sys.argv[1])
    options = [argument for argument in sys.argv[2:] if argument.startswith("-")]
    size = [int(argument) for argument in sys.argv[2:] if not argument.startswith("-")] or [1280, 800]
    with Browser(shutil.which("chromium"), shutil.which("chromedriver"), gpu=options) as browser:
        browser.size(*size)
        wrong = browser.open(page)
        if wrong:
            sys.exit(f"{page}: {wrong}")
        if browser.run("return tegl.app.inTime.length") == 0:
            sys.exit(f"{page}: no 4D contour; expected one")
        browser.run("tegl.app.togglePanel(false)")
        print(json.dumps(browser.run(MEASURE, 200), indent=1))


if __name__ == "__main__":
    main()
