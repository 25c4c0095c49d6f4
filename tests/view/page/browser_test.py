"""Opens a page from the file system in a headless Chromium: browser_test.py RICOCHET FOLDER

Checks that there is no console error, no request but the page itself, and a picture that is not empty. Turning and
scrubbing change the picture, a click picks a particle, and keys play and step. Exits with 77 without Chromium.
"""

import json
import os
import subprocess
import sys

from browser import Browser, find_browser, pixels

SCENE = {
    "ricochet": 1,
    "simulation": {"time_step": 0.05, "duration": 2},
    "camera": {"position": [0, -8, 1], "target": [0, 0, 1], "field_of_view": 40},
    "output": {"every": 2},
    "colliders": [
        {"name": "floor", "type": "plane", "normal": [0, 0, 1], "point": [0, 0, -1]},
        {"name": "block", "type": "box", "size": [0.6, 0.6, 0.6], "position": [-2, 0, 0]},
        {"name": "gate</script>", "type": "box", "size": [0.2, 0.2, 1], "motion": [
            {"time": 0, "position": [2, 1, 0]}, {"time": 2, "position": [2, 1, 2]}]},
    ],
    "particles": [
        {"position": [0, 0, 1], "radius": 0.5},
        {"position": [-1.5, 0, 2], "velocity": [1.5, 0, 0], "radius": 0.2},
    ],
}


# No particle is spawned before the third frame.
LATE = {
    "ricochet": 1,
    "simulation": {"time_step": 0.05, "duration": 0.5},
    "output": {"every": 1},
    "emitters": [{"type": "point", "center": [0, 0, 0], "rate": 30, "start": 0.12, "velocity": [1, 0, 0],
                  "particle_radius": 0.1}],
}


# An upright cross drawn by its emitter as a mesh, a ball beside it, and a bar that spins once in the run.
SHAPES = {
    "ricochet": 1,
    "simulation": {"time_step": 0.05, "duration": 2},
    "camera": {"position": [0, -8, 0], "target": [0, 0, 0], "field_of_view": 40},
    "output": {"every": 2},
    "emitters": [
        {"name": "bars", "type": "point", "center": [-1.5, 0, 0], "burst": 1, "particle_radius": 1,
         "drawing": {"particles": "meshes", "mesh": "bar.obj"}},
        {"name": "balls", "type": "point", "center": [1.5, 0, 0], "burst": 1, "particle_radius": 1}],
    "particles": [{"position": [0, 0, -2], "radius": 0.5, "spin": [0, 3.14159, 0]}],
}
BAR = "v -1 -0.1 0\nv 1 -0.1 0\nv 1 0.1 0\nv -1 0.1 0\nf 1 2 3\nf 1 3 4\n"


# A sheet with spheres that touch it, a hidden box in front of all, and a smooth ball.
SHEET = "v -3 0 -2\nv 3 0 -2\nv 3 0 2\nv -3 0 2\nf 1 2 3\nf 1 3 4\n"
RADII = (0.25, 0.4, 0.1)
TOUCHING = {
    "ricochet": 1,
    "simulation": {"time_step": 0.05, "duration": 0.1},
    "camera": {"position": [0, -8, 0], "target": [0, 0, 0], "field_of_view": 40},
    "output": {"every": 1},
    "colliders": [
        {"name": "sheet", "type": "mesh", "file": "sheet.obj", "looks": {"color": [0, 0.2, 0]}},
        {"name": "lid", "type": "box", "size": [6, 0.1, 4], "position": [0, -4, 0], "looks": {"hidden": True}},
        {"name": "ball", "type": "sphere", "radius": 0.8, "position": [0, 3, 0], "looks": {"roughness": 0.2}},
    ],
    "particles": [{"position": [0.61 * (i % 6) - 1.53, RADII[i % 3] * (1 + 1e-9), 1.2 * (i // 6) - 0.6],
                   "radius": RADII[i % 3]} for i in range(12)],
}


def check(what, is_true, *shown):
    """Ends the test with exit code 1 if a condition is false."""
    if not is_true:
        print("FAILED:", what, *shown)
        sys.exit(1)


def changed_part(a, b):
    """Returns the share of pixels that differ by more than noise between two pictures."""
    width, height, channels, rows_a = pixels(a)
    rows_b = pixels(b)[3]
    changed = 0
    for row_a, row_b in zip(rows_a, rows_b):
        if row_a != row_b:
            for x in range(0, len(row_a), channels):
                changed += max(abs(row_a[x + k] - row_b[x + k]) for k in range(3)) > 12
    return changed / (width * height)


def color_at(png, x, y):
    _, _, channels, rows = pixels(png)
    return tuple(rows[int(y)][channels * int(x):channels * int(x) + 3])


def window_place(browser, row):
    """Returns the window position of a particle of the current frame."""
    return browser.run(f"""(() => {{ const {{app, camera}} = ricochet;
        const place = app.particles.object.position.clone().set(...app.run.position(app.run.frames[app.number], {row}));
        place.project(camera); const area = app.stage.canvas.getBoundingClientRect();
        return [area.left + (place.x + 1) / 2 * area.width, area.top + (1 - place.y) / 2 * area.height]; }})()""")


def look(browser, page, folder):
    browser.open(page)
    browser.run("ricochet.loaded")
    check("all frames are unpacked", browser.run("ricochet.app.run.frames.length") == 21)
    browser.run("document.body.classList.add('bare')")
    browser.run("show(0)")
    first = browser.screenshot(os.path.join(folder, "first.png"))
    check("the picture is not empty", len(set(b"".join(pixels(first)[3]))) > 60)

    x, y = window_place(browser, 0)
    resting = color_at(first, x, y)
    check("a particle at rest has the first colour of the map", resting[2] > 70 and resting[2] > resting[1] + 50, resting)
    x, y = window_place(browser, 1)
    fast = color_at(first, x, y)
    check("the fastest particle has the last colour of the map", fast[0] > 120 and fast[1] > 120 and fast[2] < 80, fast)

    check("a requested frame is shown", browser.run("show(20)") == 20)
    last = browser.screenshot(os.path.join(folder, "last.png"))
    check("moved particles are drawn elsewhere", 0.001 < changed_part(first, last) < 0.2, changed_part(first, last))
    moved = window_place(browser, 1)
    check("the particle has moved to the right", moved[0] > x + 100, moved, x)
    check("and is drawn there", changed_part(last, first) > 0 and color_at(last, *moved) != color_at(first, *moved))
    browser.run("show(0)")
    check("the first frame looks as before", changed_part(first, browser.screenshot()) == 0)

    browser.drag((480, 300), (620, 300))
    turned = browser.screenshot(os.path.join(folder, "turned.png"))
    check("dragging turns the picture", changed_part(first, turned) > 0.02, changed_part(first, turned))
    check("and keeps the distance", abs(browser.run("camera = ricochet.camera, camera.position.distanceTo("
                                                    "ricochet.app.stage.controls.target)") - 8) < 1e-3)
    browser.run("ricochet.app.stage.reset_view(), ricochet.app.stage.draw()")
    check("the first view comes back", changed_part(first, browser.screenshot()) == 0)

    browser.run("document.body.classList.remove('bare')")
    x, y = window_place(browser, 0)
    browser.drag((x, y), (x, y), steps=1)
    check("a click picks the particle", browser.run("ricochet.app.picked") == 0, browser.run("ricochet.app.picked"))
    card = browser.run("document.getElementById('picked').textContent")
    check("and its values are shown", "radius, m0.5" in card and "speed, m/s0" in card, card)
    browser.screenshot(os.path.join(folder, "picked.png"))
    check("a click on the background picks no particle", browser.run("ricochet.pick(480, 20)") is None)

    browser.run("ricochet.app.change({trails: true, body_map: 'hits'}), show(12)")
    browser.key("ArrowRight")
    check("a key goes one frame on", browser.run("show(ricochet.app.number)") == 13)
    browser.key(" ", "Space")
    browser.run("new Promise((resolve) => setTimeout(resolve, 1500))")
    check("it plays", browser.run("ricochet.app.is_playing && ricochet.app.number !== 13"))
    browser.key(" ", "Space")
    browser.run("show(20)")
    gate = browser.run("ricochet.app.rigid[0].object.matrix.elements[14]")
    check("colliders that move have moved", abs(gate - 2) < 1e-6, gate)
    browser.key("d")
    browser.screenshot(os.path.join(folder, "dark.png"))
    check("the theme has changed", browser.run("document.documentElement.dataset.theme") == "dark")


def look_at_late_one(browser, page):
    browser.open(page)
    number, counts = browser.run("ricochet.app.number"), browser.run("ricochet.app.run.description.frames.count")
    check("it begins empty", counts[0] == 0, counts)
    check("the page opens on the first frame that has particles", counts[number] > 0 and sum(counts[:number]) == 0,
          number, counts)
    browser.run("ricochet.loaded")
    check("and stays there", browser.run("ricochet.app.number") == number)
    check("the empty ones can be shown", browser.run("show(0)") == 0)


def bright_around(browser, png, row, radius):
    """Returns the share of pixels around a particle that do not have the colour of the background."""
    width, _, channels, rows = pixels(png)
    x, y = (int(v) for v in window_place(browser, row))
    sky = rows[5][0:3]
    inside = [rows[j][channels * i:channels * i + 3] for j in range(y - radius, y + radius)
              for i in range(x - radius, x + radius)]
    return sum(max(abs(one[k] - sky[k]) for k in range(3)) > 60 for one in inside) / len(inside)


def look_at_shapes(browser, page, folder):
    browser.open(page)
    browser.run("ricochet.loaded")
    browser.run("document.body.classList.add('bare'), ricochet.app.set_theme('light')")
    browser.run("show(4)")
    shapes = browser.run("ricochet.app.particles.copies.map((copies) => copies.geometry.instanceCount)")
    check("one particle is a copy of the mesh", shapes == [1], shapes)
    first = browser.screenshot(os.path.join(folder, "shapes.png"))
    bar, ball = bright_around(browser, first, 1, 70), bright_around(browser, first, 2, 70)
    check("a bar covers less than a ball", 0.01 < bar < 0.6 * ball, bar, ball)
    check("frames have turns", browser.run("ricochet.app.run.frames[4].turns.length") == 3)
    turns = browser.run("[1, 11].map((k) => ricochet.app.run.frames[k].turns.map((axis) => axis[0]))")
    w = [(1 - sum(v * v for v in turn)) ** 0.5 if sum(v * v for v in turn) < 1 else 0 for turn in turns]
    half = abs(sum(a * b for a, b in zip(*turns)) + w[0] * w[1])
    check("a second's spin of half a turn turns by that", half < 0.02, turns, half)
    browser.run("ricochet.app.change({drawing: 'soft'}), ricochet.app.stage.draw()")
    browser.run("show(4)")
    check("drawn as discs, all particles are round", not browser.run("ricochet.app.particles.copies[0].object.visible"))
    browser.run("ricochet.app.change({drawing: 'spheres'})")
    browser.run("show(4)")
    check("and drawn as copies they look as before", changed_part(first, browser.screenshot()) == 0)


def count_colors(png, is_wanted, area=None):
    """Returns the number of pixels with a wanted colour in a picture, or in its area (left, top, right, bottom)."""
    width, height, channels, rows = pixels(png)
    left, top, right, bottom = (int(v) for v in area or (0, 0, width, height))
    return sum(is_wanted(*row[channels * x:channels * x + 3]) for row in rows[top:bottom] for x in range(left, right))


def look_at_touching(browser, page, folder):
    browser.open(page)
    browser.run("ricochet.loaded")
    browser.run("document.body.classList.add('bare'), ricochet.app.set_theme('light')")
    shown = browser.run("ricochet.app.bodies.map((body) => body.object.visible)")
    check("hidden colliders are not shown", shown == [True, False, True], shown)
    boxes = browser.run("[...document.querySelectorAll('.body')].map((row) => row.querySelector('input').checked)")
    check("and can be made visible", boxes == shown, boxes)

    def is_blue(red, green, blue):
        return blue > red + 25 and blue > green + 25

    for around, over in ((0, 0), (0.4, 0), (0.35, 0.3), (-1.2, -0.7)):
        browser.run(f"ricochet.orbit({around}, {over})")
        browser.run("show(1)")
        through = count_colors(browser.screenshot(os.path.join(folder, f"behind_{around}_{over}.png")), is_blue)
        check("no sphere is seen through the wall that it touches", through == 0, around, over, through)
    browser.run("ricochet.app.stage.reset_view(), ricochet.orbit(2.6, 0.2)")
    browser.run("show(1)")
    front = browser.screenshot(os.path.join(folder, "touching.png"))
    check("from the other side they are seen", count_colors(front, is_blue) > 3000, count_colors(front, is_blue))
    x, y = window_place(browser, 4)
    light = count_colors(front, lambda *rgb: min(rgb) > 150, (x - 50, y - 50, x + 50, y + 50))
    check("and the page does not shine through their rims", light == 0, light)
    browser.run("ricochet.app.bodies[2].material.uniforms.roughness.value = 1")
    browser.run("show(1)")
    matt = changed_part(front, browser.screenshot(os.path.join(folder, "matt.png")))
    check("a smooth ball has a highlight", 1e-4 < matt < 0.1, matt)


def view(program, scene_data, folder, name):
    """Runs a scene and returns the path of its page."""
    scene, page = os.path.join(folder, name + ".json"), os.path.join(folder, name + ".html")
    with open(scene, "w", encoding="utf-8") as stream:
        json.dump(scene_data, stream)
    subprocess.run([program, "view", scene, "--output", page, "--run-output", os.path.join(folder, name), "--quiet"],
                   check=True)
    return page


def main():
    program, folder = sys.argv[1:3]
    path = find_browser()
    if path is None:
        print("SKIPPED: there is no chromium here (apt install chromium)")
        sys.exit(77)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "bar.obj"), "w", encoding="utf-8") as stream:
        stream.write(BAR)
    with open(os.path.join(folder, "sheet.obj"), "w", encoding="utf-8") as stream:
        stream.write(SHEET)
    page, late = view(program, SCENE, folder, "page"), view(program, LATE, folder, "late")
    shapes, touching = view(program, SHAPES, folder, "shapes"), view(program, TOUCHING, folder, "touching")
    browser = Browser(path)
    try:
        look(browser, page, folder)
        look_at_late_one(browser, late)
        look_at_shapes(browser, shapes, folder)
        look_at_touching(browser, touching, folder)
        check("the console stays empty", browser.console == [], browser.console)
        pages = ["file://" + os.path.abspath(one) for one in (page, late, shapes, touching)]
        outside = [url for url in browser.requests if not url.startswith(("blob:", *pages))]
        check("the page makes no requests", outside == [], outside)
        check("no error", browser.run("ricochet.errors") == [])
    finally:
        browser.close()
    print("passed")


if __name__ == "__main__":
    main()
