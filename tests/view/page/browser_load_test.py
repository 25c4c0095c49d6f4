"""Plays 200,000 particles in 100 frames in a headless Chromium: browser_load_test.py RICOCHET FOLDER

Checks that the page fits its budget, unpacks and plays. Prints memory and times. Exits with 77 without Chromium.
"""

import json
import os
import subprocess
import sys

from browser import Browser, find_browser, pixels
from browser_test import check

SCENE = {
    "ricochet": 1,
    "simulation": {"time_step": 0.02, "duration": 2},
    "output": {"every": 1},
    "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]}],
    "emitters": [{"type": "disk", "center": [0, 0, 3], "normal": [0, 0, 1], "radius": 2, "burst": 200000,
                  "speed": [2, 1], "cone": 60}],
}

# Measures milliseconds per picture. Each shows another frame and is read back, so that it is complete.
MEASURE = """(async () => {
  const {app} = ricochet;
  const context = app.stage.renderer.getContext();
  const pixel = new Uint8Array(4);
  const begin = performance.now();
  for (let i = 0; i < 3; ++i) {
    await show(Math.floor(app.run.frame_count * (i + 1) / 4));
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, pixel);
  }
  const picture = (performance.now() - begin) / 3;
  const marks = Object.fromEntries(performance.getEntriesByType('mark').map((m) => [m.name, Math.round(m.startTime)]));
  const held = app.run.frames.reduce((sum, f) => sum + f.positions.byteLength + f.ids.byteLength +
      f.values.reduce((s, v) => s + (v === null ? 0 : v.byteLength), 0), 0);
  return {picture_ms: Math.round(picture), heap_mb: Math.round(performance.memory.usedJSHeapSize / 1e6),
          held_mb: Math.round(held / 1e6), ...marks};
})()"""


def main():
    program, folder = sys.argv[1:3]
    path = find_browser()
    if path is None:
        print("SKIPPED: there is no chromium here (apt install chromium)")
        sys.exit(77)
    os.makedirs(folder, exist_ok=True)
    scene, page = os.path.join(folder, "scene.json"), os.path.join(folder, "page.html")
    with open(scene, "w", encoding="utf-8") as stream:
        json.dump(SCENE, stream)
    made = subprocess.run([program, "view", scene, "--output", page, "--run-output", os.path.join(folder, "run")],
                          check=True, capture_output=True, text=True)
    print(*made.stdout.strip().splitlines()[-2:], sep="\n", flush=True)
    check("the budget is kept", os.path.getsize(page) <= 30e6, os.path.getsize(page))
    browser = Browser(path, (640, 400))
    try:
        browser.open(page, timeout=600)
        browser.run("ricochet.loaded", timeout=600)
        result = browser.run(MEASURE, timeout=1800)
        print(result, flush=True)
        first, all_frames = result["first picture"], result["all frames unpacked"]
        check("the first picture comes while the rest still unpacks", first < all_frames, result)
        check("memory is about a dozen bytes per particle and frame", result["held_mb"] < 400, result)
        png = browser.screenshot(os.path.join(folder, "many.png"))
        check("the picture is not empty", len(set(b"".join(pixels(png)[3]))) > 60)
        check("the console stays empty", browser.console == [], browser.console)
    finally:
        browser.close()
    print("passed")


if __name__ == "__main__":
    main()
