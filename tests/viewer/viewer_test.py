#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of `tegl view` as a browser shows them.

    viewer_test.py TEGL CHROMIUM CHROMEDRIVER OCEAN
"""

import re
import sys
import time
import unittest

import numpy as np
from selenium.webdriver.common.keys import Keys

from browser import Browser, write_balls, write_noise, write_nrrd, write_scan
from pages import CHROMEDRIVER, CHROMIUM, LABELS, OCEAN, Pages, count_of_cut, pixels, tegl


class Viewer(Pages):
    def test_renders_from_a_file_and_the_slider_changes_the_picture(self):
        browser = self.open()
        self.assertEqual(browser.run("return location.protocol"), "file:")
        self.assertEqual(browser.run("return performance.getEntriesByType('resource').map(({ name }) => name)"
                                     ".filter((name) => !name.startsWith('data:'))"), [])
        browser.run("tegl.time = 1")
        apart = self.picture()
        self.assertGreater(self.drawn(apart), 2000)
        slider = browser.element("#slider")
        browser.run("arguments[0].value = 0.93; arguments[0].dispatchEvent(new Event('input'))", slider)
        self.assertAlmostEqual(browser.run("return tegl.time"), browser.run("return 0.07 * tegl.range[0] + 0.93 * tegl.range[1]"))
        self.assertGreater(self.different(apart, self.picture()), 1000)
        # Continuously: a hundredth of a step is another picture too.
        browser.run("tegl.time = 1.01")
        self.assertGreater(self.different(apart, self.picture()), 20)

    def test_counts_of_triangles_are_the_librarys(self):
        times = [0, 0.1, 1, 1.5, 2, 2.25, 3, 3.999, 4, 5]
        write_noise(self.folder / "noise.nrrd", (8, 8, 8, 6), seed=7)
        self.same_counts("noise", 2, times)
        self.same_counts("noise", 2, times, "--close", "--precision", "float")
        browser = self.browser
        exact = browser.run("""const { times } = tegl.app.layers[0].cuts;
            return [1, 3, 5, 7].map((i) => times[Math.floor(i * times.length / 8)])""")
        self.assertEqual([browser.run("tegl.time = arguments[0]; return tegl.count()", t) for t in exact],
                         [count_of_cut(self.folder / "noise.vtkhdf", t, self.folder) for t in exact])

    def test_counts_beside_missing_values(self):
        def value(x, y, z, t):
            if (x, y, z, t) == (3, 3, 3, 2) or t < 2 and x > 4:
                return float("nan")
            return (x * 7 + y * 5 + z * 3 + t * 11) % 6

        write_nrrd(self.folder / "missing.nrrd", (8, 7, 7, 5), value)
        self.same_counts("missing", 3, [0, 0.5, 1, 1.25, 2, 2.001, 2.5, 3, 3.7, 4])

    def test_the_cut_looks_like_the_librarys(self):
        browser = self.open()
        browser.run("tegl.time = 2.3; tegl.colorBy('plain')")
        here = self.picture()
        tegl("slice", self.folder / "balls.vtkhdf", "--at", "t=2.3", "-o", self.folder / "cut.ply", "-q")
        tegl("view", self.folder / "cut.ply", "-o", self.folder / "cut.html", "-q")
        camera = browser.run("""const { camera, sides, scale } = tegl.app.stage;
            return { position: camera.position.toArray(), aspect: camera.aspect, center: tegl.app.stage.center, scale }""")
        self.open("cut.html")
        # As far from the same point, in the same scale, in a picture of the same size.
        browser.run("""const { stage } = tegl.app;
            document.getElementById('time').hidden = false;
            document.getElementById('time').style.height = '0';
            tegl.colorBy('plain');
            const given = arguments[0];
            stage.center = given.center;
            for (const layer of stage.layers) layer.place(given.center, given.scale);
            for (const { uniforms } of stage.layers) { uniforms.uLower.value.set(-1e9, -1e9, -1e9); uniforms.uUpper.value.set(1e9, 1e9, 1e9); }
            stage.camera.aspect = given.aspect;
            stage.camera.position.set(...given.position);
            stage.camera.updateProjectionMatrix();
            stage.controls.update();
            stage.resize = () => {};
            stage.renderer.setSize(arguments[1], arguments[2], false);""", camera, len(here[0]), len(here))
        there = self.picture()
        self.assertEqual(here.shape, there.shape)
        is_ground = [(picture == here[0, 0]).all(axis=2) for picture in (here, there)]
        outlines = (is_ground[0] != is_ground[1]).sum()
        self.assertLess(outlines, 0.01 * self.drawn(here))
        apart = (abs(here - there).max(axis=2) > 12).sum()
        self.assertLess(apart, 0.02 * self.drawn(here))

    def test_play_flows_loops_and_stops(self):
        browser = self.open()
        browser.run("tegl.time = 1")
        browser.element("#play").click()
        browser.until("tegl.time > 1.02")
        frames = browser.run("return tegl.frames")
        browser.until(f"tegl.frames > {frames} + 3")
        browser.run("tegl.time = tegl.range[1] - 0.01")
        browser.until("tegl.time < 4")  # around
        browser.element("#loop").click()
        browser.run("tegl.time = tegl.range[1] - 0.01")
        browser.until("tegl.time === tegl.range[1] && document.getElementById('play').ariaPressed === 'false'")

    def test_events_are_clicked_on(self):
        browser = self.open()
        merge = browser.element("#graph .event.merge")
        merge.click()
        self.assertRegex(merge.get_attribute("aria-label"), r"^t [\d.]+: 2 components merge at \(")
        event = browser.run("return tegl.app.event")
        self.assertEqual(event["kind"], "merge")
        self.assertEqual(browser.run("return tegl.time"), event["time"])
        self.assertIn("2 components merge", browser.element("#now").text)
        self.assertTrue(browser.element(".marker").is_displayed())
        browser.element("#before").click()
        self.assertLess(browser.run("return tegl.time"), event["time"])

    def test_events_count_all_parts_and_say_how_many_are_drawn(self):
        browser = self.view("one", self.folder / "balls.vtkhdf", "--tracks", 1)
        label = browser.element("#graph .event.merge").get_attribute("aria-label")
        self.assertRegex(label, r"^t [\d.]+: 2 components merge \(1 of them drawn\) at \(")
        self.assertEqual(browser.element("#graph-note").text, "1 of 2 tracks, those with the longest lifetime, with 3 of 4 events.")
        events = browser.run("return tegl.app.timeline.events()")
        self.assertEqual([(event["parts_in"], event["parts_out"]) for event in events if event["kind"] == "merge"], [(2, 1)])
        write_balls(self.folder / "apart.nrrd", is_backwards=True)
        browser = self.view("apart", self.folder / "apart.nrrd", "--iso", 0, "--tracks", 1)
        label = browser.element("#graph .event.split").get_attribute("aria-label")
        self.assertRegex(label, r": a component splits into 2 \(1 of them drawn\) at \(")
        browser = self.open()
        self.assertEqual(browser.element("#graph-note").text, "", "all are drawn")
        words = browser.run("""const { timeline } = tegl.app;
            const event = { kind: 'exchange', time: 1, place: [0.5], in: [0, 1], out: [2], parts_in: 2, parts_out: 3 };
            return ['merge', 'exchange'].map((kind) => timeline.describe({ ...event, kind })).concat(
                timeline.describe({ ...event, kind: 'birth', parts_in: 0, in: [] }),
                timeline.describe({ ...event, kind: 'death', parts_in: 1, in: [0], parts_out: 0, out: [] }))""")
        self.assertEqual(words, ["2 components merge at (0.5)", "2 components meet and become 3 at (0.5)",
                                 "3 components are born (1 of them drawn) at (0.5)", "a component dies at (0.5)"])

    def test_a_crowd_of_events_is_marks_with_numbers_that_do_not_overlap(self):
        write_noise(self.folder / "crowd.nrrd", (9, 9, 9, 12), seed=3)
        browser = self.view("crowd", self.folder / "crowd.nrrd", "--iso", 2, "--tracks", 10000)
        events = browser.run("return tegl.app.timeline.events()")
        self.assertGreater(len(events), 300)
        marks = browser.run("""return [...document.querySelectorAll('#graph .event')].map((mark) => {
            const { left, right, top } = mark.querySelector('.plate, .dot').getBoundingClientRect();
            return { left, right, lane: mark.transform.baseVal[0].matrix.f, count: Number(mark.dataset.count), first: Number(mark.dataset.event),
              text: mark.querySelector('.number')?.textContent ?? '1', label: mark.getAttribute('aria-label') };
        })""")
        self.assertEqual(sum(mark["count"] for mark in marks), len(events))
        self.assertEqual([int(mark["text"]) for mark in marks], [mark["count"] for mark in marks])
        self.assertEqual([mark["first"] for mark in marks], sorted({mark["first"] for mark in marks}))
        lanes = {}
        for mark in marks:
            lanes.setdefault(mark["lane"], []).append((mark["left"], mark["right"]))
        for lane, places in lanes.items():
            places.sort()
            for (_, right), (left, _) in zip(places, places[1:]):
                self.assertGreater(left, right - 2.5, (lane, right, left))
        crowd = max(marks, key=lambda mark: mark["count"])
        self.assertGreater(crowd["count"], 3)
        self.assertRegex(crowd["label"], rf"^{crowd['count']} events, (axis 3|t) [\d.]+( to (axis 3|t) [\d.]+)?: \d+ ")
        kinds = re.findall(r"(\d+) (merge|split|exchange|birth|death|start|end|entr|exit)", crowd["label"].split(": ")[1])
        self.assertEqual(sum(int(count) for count, _ in kinds), crowd["count"])
        # Each click leads to the next event of the crowd.
        several = next(mark for mark in marks if mark["count"] > 1 and " to " in mark["label"])
        selector = f"#graph .event[data-event=\"{several['first']}\"]"
        times = [browser.run("document.querySelector(arguments[0]).dispatchEvent(new Event('click')); return tegl.time", selector)
                 for _ in range(2 * several["count"])]
        self.assertGreater(len(set(times)), 1)
        self.assertLess(max(times) - min(times), 0.5)
        # Those at one time are counted.
        together = next(event for event in events if sum(other["time"] == event["time"] for other in events) > 2)
        others = sum(other["time"] == together["time"] for other in events) - 1
        browser.run("tegl.app.goTo(arguments[0])", together)
        self.assertIn(f", and {others} other events at this time", browser.element("#now").text)

    def test_colors_have_legends(self):
        browser = self.open()
        self.assertEqual(browser.run("return tegl.colorings()"), ["plain", "component", "track", "axis0", "axis1", "axis2", "time"])
        browser.run("tegl.time = 0.5")
        pictures = []
        for id in ("plain", "track", "axis0", "time"):
            browser.run("tegl.colorBy(arguments[0])", id)
            pictures.append(self.picture())
            self.assertEqual(browser.element("#legend").is_displayed(), id != "plain")
        for i, one in enumerate(pictures):
            for j, other in enumerate(pictures[:i]):
                self.assertGreater(self.different(one, other), 500, (i, j))
        tegl("contour", OCEAN, "--iso", 27, "--attribute", f"{OCEAN}:temperature", "-o", self.folder / "warm.vtkhdf", "-q")
        tegl("view", self.folder / "warm.vtkhdf", "-o", self.folder / "warm.html", "-q")
        browser = self.open("warm.html")
        for id, title in (("vertex0", "temperature (degC)"), ("time", "time (month)"), ("axis2", "depth (m)")):
            browser.run("tegl.colorBy(arguments[0])", id)
            self.assertEqual(browser.element("#legend .legend-title").text, title)

    def test_parts_have_their_colors_right_after_a_split(self):
        write_balls(self.folder / "split.nrrd", is_backwards=True)
        tegl("view", self.folder / "split.nrrd", "--iso", 0, "-o", self.folder / "split.html", "-q")
        browser = self.open("split.html")
        split = browser.run("return tegl.app.timeline.events().find(({ kind }) => kind === 'split').time")
        self.assertTrue(5 < split < 5.5)  # the picture is in the same step of the data
        browser.run("tegl.time = 5.9; tegl.colorBy('track')")
        picture = self.picture()
        is_drawn, is_blue = (picture != picture[0, 0]).any(axis=2), picture[..., 2] > picture[..., 0]
        blue, other = (is_drawn & is_blue).any(axis=0), (is_drawn & ~is_blue).any(axis=0)  # columns
        self.assertGreater((blue & ~other).sum(), 40)
        self.assertGreater((other & ~blue).sum(), 40)
        self.assertLess((blue & other).sum(), 10)

    def test_clipping_leaves_out(self):
        browser = self.open()
        browser.run("tegl.time = 1")
        whole = self.drawn(self.picture())
        for axis in range(3):
            browser.run("tegl.clip(arguments[0], 0.5, 1)", axis)
            self.assertLess(self.drawn(self.picture()), 0.95 * whole)
            browser.element("#unclip").click()
        self.assertEqual(self.drawn(self.picture()), whole)

    def test_what_is_not_clipped_has_no_gaps(self):
        # a prism of ten sides, with two edges on the sides of the box
        write_nrrd(self.folder / "prism.nrrd", (5, 5, 2), lambda x, y, z: 1.3 - ((x - 2.1)**2 + (y - 1.9)**2)**0.5)
        browser = self.view("prism", self.folder / "prism.nrrd", "--iso", 0)
        clipped_at_the_box = self.picture()
        browser.run("for (const { uniforms } of tegl.app.stage.layers) {"
                    " uniforms.uLower.value.setScalar(-1e6); uniforms.uUpper.value.setScalar(1e6); } tegl.app.stage.redraw()")
        self.assertGreater(self.drawn(clipped_at_the_box), 2000)
        self.assertEqual(self.different(clipped_at_the_box, self.picture()), 0)

    def test_the_mouse_turns_zooms_and_moves(self):
        browser = self.open()
        seen = [self.picture()]

        def mouse(kind, x, y, **more):
            browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **more})

        for button in ("left", "right"):
            mouse("mousePressed", 200, 150, button=button, clickCount=1)
            for x in (220, 240, 260):
                mouse("mouseMoved", x, 160, button=button, buttons=1 if button == "left" else 2)
            mouse("mouseReleased", 260, 160, button=button, clickCount=1)
            seen.append(self.picture())
            self.assertGreater(self.different(*seen[-2:]), 500)
        before = browser.run("return tegl.app.stage.camera.position.distanceTo(tegl.app.stage.controls.target)")
        mouse("mouseWheel", 200, 150, deltaX=0, deltaY=-240)
        browser.until(f"tegl.app.stage.camera.position.distanceTo(tegl.app.stage.controls.target) < {0.95 * before}")
        browser.element("#reset").click()
        self.assertLess(self.different(seen[0], self.picture()), 200)

    def test_fingers_turn_and_pinch(self):
        self.browser.size(390, 844)
        browser = self.open()
        place = "tegl.app.stage.camera.position"
        before = browser.run(f"return {place}.toArray()")

        def touch(kind, *points):
            browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
                "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

        touch("touchStart", (150, 300))
        for x in (170, 190, 210):
            touch("touchMove", (x, 300))
        touch("touchEnd")
        browser.until(f"{place}.distanceTo({{x: {before[0]}, y: {before[1]}, z: {before[2]}}}) > 0.3")
        away = browser.run(f"return {place}.length()")
        touch("touchStart", (180, 300), (200, 300))
        for out in (20, 40, 60):
            touch("touchMove", (180 - out, 300), (200 + out, 300))
        touch("touchEnd")
        browser.until(f"{place}.distanceTo(tegl.app.stage.controls.target) < {0.8 * away}")

    def test_keys(self):
        browser = self.open()
        press = lambda key: browser.run("dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true}))"
                                        .replace("dispatchEvent(", "document.body.dispatchEvent("), key)
        press("Home")
        self.assertEqual(browser.run("return tegl.time === tegl.range[0]"), True)
        press("ArrowRight")
        self.assertGreater(browser.run("return tegl.time"), browser.run("return tegl.range[0]"))
        press("End")
        self.assertEqual(browser.run("return tegl.time === tegl.range[1]"), True)
        press("d")
        self.assertEqual(browser.run("return document.documentElement.dataset.theme"), "dark")
        press("l")
        self.assertEqual(browser.run("return tegl.app.loops"), False)
        press("]")
        self.assertEqual(browser.run("return tegl.app.speed"), 2)
        press("?")
        self.assertTrue(browser.element("#keys").is_displayed())

    def test_keys_work_while_a_slider_or_a_list_has_the_focus(self):
        browser = self.open()
        theme, speed = "document.documentElement.dataset.theme", "tegl.app.speed"
        state = lambda what: browser.run(f"return {what}")
        for selector in ("#clips input", "#stretch", "#slider"):
            slider = browser.element(selector)
            browser.run("tegl.time = 2; arguments[0].focus()", slider)
            for key, what in (("d", theme), ("]", speed), ("[", speed), ("l", "tegl.app.loops"), ("c", "tegl.app.current.source.id")):
                before = state(what)
                slider.send_keys(key)
                self.assertNotEqual(state(what), before, (selector, key))
            before = state("tegl.time")
            slider.send_keys(" ")
            browser.until(f"tegl.time !== {before}")  # it plays
            slider.send_keys(" ")
            # What moves the knob is the slider's.
            time, value = state("tegl.time"), float(slider.get_property("value"))
            slider.send_keys(Keys.ARROW_RIGHT)
            self.assertGreater(float(slider.get_property("value")), value, selector)
            (self.assertGreater if selector == "#slider" else self.assertEqual)(state("tegl.time"), time, selector)
            slider.send_keys("?")
            self.assertTrue(browser.element("#keys").is_displayed())
            browser.run("document.getElementById('keys').close(); tegl.theme('light')")
        # A list takes letters, for its choices, and leaves the rest to the page.
        choice = browser.element("#color")
        before = state(theme), state(speed)
        choice.send_keys("d")
        self.assertEqual(state(theme), before[0])
        choice.send_keys("]")
        self.assertNotEqual(state(speed), before[1])
        # Of a box only the space is its own.
        box = browser.element("#smooth")
        checked = box.is_selected()
        box.send_keys(" ")
        self.assertNotEqual(box.is_selected(), checked)
        box.send_keys("d")
        self.assertEqual(state(theme), "dark")

    def test_the_keyboard_turns_moves_and_zooms(self):
        browser = self.open()
        browser.run("document.getElementById('canvas').focus()")
        press = lambda key, shift=False: browser.run(
            "document.activeElement.dispatchEvent(new KeyboardEvent('keydown',"
            "{key: arguments[0], shiftKey: arguments[1], bubbles: true}))", key, shift)
        seen, time = [self.picture()], browser.run("return tegl.time")
        for key, shift in (("ArrowRight", False), ("ArrowUp", False), ("ArrowLeft", True), ("+", False)):
            for _ in range(3):
                press(key, shift)
            seen.append(self.picture())
            self.assertGreater(self.different(*seen[-2:]), 500, key)
        self.assertEqual(browser.run("return tegl.time"), time)
        press("r")
        self.assertLess(self.different(seen[0], self.picture()), 200)

    def test_the_tab_key_stops_once_at_the_events_and_arrows_go_on(self):
        browser = self.open()
        stops = "document.querySelectorAll('#graph .event[tabindex=\"0\"]')"
        press = lambda key: browser.run(
            "document.activeElement.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true}))", key)
        self.assertGreater(browser.run("return document.querySelectorAll('#graph .event').length"), 2)
        self.assertEqual(browser.run(f"return {stops}.length"), 1)
        time = browser.run(f"{stops}[0].focus(); return tegl.time")
        press("ArrowRight")
        press("ArrowRight")
        self.assertEqual(browser.run(f"return {stops}.length"), 1)
        self.assertEqual(browser.run("return tegl.time"), time)
        self.assertEqual(browser.run("return document.activeElement.dataset.event"), "2")
        press("Enter")
        self.assertEqual(browser.run("return tegl.time"), browser.run("return tegl.app.timeline.events()[2].time"))

    def test_light_and_dark(self):
        self.browser.prefer("dark")
        browser = self.open()
        brightness = lambda: sum(self.picture()[0][0])
        self.assertLess(brightness(), 150)
        browser.element("#theme").click()
        self.assertGreater(brightness(), 600)

    def test_fits_a_phone(self):
        self.browser.size(390, 844, 2.0)
        browser = self.open()
        self.assertEqual(browser.run("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"), [390, 844])
        out = """return [...document.querySelectorAll('header *, footer *, #legend')].filter((element) => {
            const box = element.getBoundingClientRect();
            const isSeen = box.width > 0 && !element.closest('#graph') && !element.closest('option');
            return isSeen && (box.left < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5);
        }).map((element) => element.outerHTML.slice(0, 80))"""
        self.assertEqual(browser.run(out), [])
        self.assertFalse(browser.element("#panel").is_displayed())
        browser.element("#more").click()
        self.assertTrue(browser.element("#panel").is_displayed())
        self.assertEqual(browser.run(out), [])
        small = browser.run("""return [...document.querySelectorAll('header button, footer button')].filter((button) =>
            button.offsetWidth > 0 && Math.min(button.offsetWidth, button.offsetHeight) < 34).length""")
        self.assertEqual(small, 0)

    def test_the_panel_needs_no_scroll_bar_on_a_laptop(self):
        tegl("view", OCEAN, "--iso", 20, "-o", self.folder / "laptop.html", "-q")
        self.browser.size(1280, 757)
        browser = self.open("laptop.html")
        height, shown = browser.run("const panel = document.getElementById('panel'); return [panel.scrollHeight, panel.clientHeight]")
        self.assertGreater(shown, 200)
        self.assertLessEqual(height, shown)

    def test_small_pages_are_mostly_picture(self):
        tegl("view", OCEAN, "--iso", 27, "--tracks", 30, "-o", self.folder / "small.html", "-q")
        for size, least in (((844, 390), 0.75), ((667, 375), 0.75), ((320, 568), 0.6)):
            self.browser.size(*size)
            browser = self.open("small.html")
            share = lambda: browser.run("""const { offsetWidth, offsetHeight } = document.getElementById('stage');
                return offsetWidth * offsetHeight / (innerWidth * innerHeight)""")
            self.assertGreater(share(), least, size)
            self.assertEqual(browser.run("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"),
                             list(size))
            self.assertFalse(browser.element("#panel").is_displayed())
            for id in ("track", "axis2", "time"):
                browser.run("tegl.colorBy(arguments[0])", id)
                covered = browser.run("""const of = (id) => { const box = document.getElementById(id).getBoundingClientRect();
                    return box.width * box.height; };
                    return of('legend') / of('stage')""")
                self.assertGreater(covered, 0)
                self.assertLess(covered, 0.09, (size, id))
            out = browser.run("""return [...document.querySelectorAll('header *, footer *, #legend')].filter((element) => {
                const box = element.getBoundingClientRect();
                return box.width > 0 && !element.closest('#graph, option') &&
                  (box.left < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5);
            }).map((element) => element.outerHTML.slice(0, 80))""")
            self.assertEqual(out, [], size)
            # The panel lies over the picture when asked for, and the graph is there.
            before = share()
            browser.element("#more").click()
            self.assertTrue(browser.element("#panel").is_displayed())
            self.assertEqual(share(), before)
            if size[0] > size[1]:
                self.assertFalse(browser.element("#graph").is_displayed())
                browser.element("#tracks").click()
            browser.until("document.querySelector('#graph .event')?.getBoundingClientRect().width > 0")
        # Turned, a page does not hide its picture either.
        self.browser.size(1280, 800)
        browser = self.open("small.html")
        self.assertTrue(browser.element("#panel").is_displayed())
        self.browser.size(844, 390)
        browser.until("document.getElementById('app').classList.contains('no-panel')")

    def test_labels_overlap_neither_each_other_nor_the_box_nor_the_legend(self):
        write_scan(self.folder / "scan.nii")
        write_nrrd(self.folder / "flat.nrrd", (12, 9), lambda x, y: 4 - ((x - 5.5)**2 + (y - 4)**2)**0.5)
        pages = {"balls": ("balls.vtkhdf", 9), "ocean27": (OCEAN, 9), "scan": ("scan.nii", 9), "flat": ("flat.nrrd", 6)}
        for name, (file, most) in pages.items():
            if name != "balls":
                tegl("view", self.folder / file, "--iso", 27 if file == OCEAN else 0, "-o", self.folder / f"{name}.html", "-q")
            for size in ((1280, 800), (844, 390), (320, 568)):
                self.browser.size(*size)
                browser = self.open(f"{name}.html")
                browser.run("tegl.colorBy(tegl.colorings()[1])")
                time.sleep(0.1)  # until the legend has its place
                first = browser.run(LABELS)
                self.assertEqual(first["wrong"], [], (name, size))
                self.assertGreaterEqual(len(first["texts"]), most if size[0] > 1000 else most - 2, (size, first))
                seen = 0
                for turn in range(24):
                    browser.run("tegl.app.stage.turn(...arguments[0]); if (arguments[1] === 12) tegl.app.stage.zoom(0.6)",
                                [3 + turn % 4, 2 if turn % 8 < 4 else -2, False], turn)
                    found = browser.run(LABELS)
                    self.assertEqual(found["wrong"], [], (name, size, turn))
                    seen += len(found["texts"])
                self.assertGreater(seen, 4 if name == "flat" else 60, (name, size))  # what is moved out of sight has no labels

    def test_both_ends_of_an_axis_have_as_many_digits(self):
        for name, file, iso in (("balls", None, None), ("digits27", OCEAN, 27)):
            if file:
                tegl("view", file, "--iso", iso, "-o", self.folder / f"{name}.html", "-q")
            browser = self.open(f"{name}.html")
            texts = browser.run("""const all = (selector) => [...document.querySelectorAll(selector)].map((e) => e.textContent);
                const pairs = all('.clip .range').map((text) => text.split(' … '));
                const [low, high] = [all('.axis-label.lowest'), all('.axis-label.highest')];
                low.forEach((text, a) => pairs.push([text, high[a]]));
                for (const id of ['axis0', 'axis1', 'axis2', 'time']) {
                  tegl.colorBy(id);
                  pairs.push(all('#legend .ends span'));
                }
                return pairs""")
            self.assertEqual(len(texts), 10)
            for pair in texts:
                self.assertEqual(len({len(text.partition(".")[2]) for text in pair}), 1, pair)

    def test_the_sides_of_a_patient_are_shown_where_they_are_known(self):
        write_scan(self.folder / "ras.nii")
        ends = lambda browser: browser.run("return [...document.querySelectorAll('.axis-label b')].map((b) => b.textContent).join('')")
        side = "return tegl.app.stage.camera.position.y"
        browser = self.view("ras", self.folder / "ras.nii", "--iso", 0)
        self.assertEqual(ends(browser), "LRPAIS")  # x, y, z: the lowest end, the highest
        self.assertIn("R right, L left", browser.element("#world").text)
        self.assertGreater(browser.run(side), 0)  # from the front
        # Right is where x is highest: seen from the front, at the left.
        tegl_draw = "tegl.draw(); const at = (end) => tegl.app.stage.onScreen([end, 0, 0]).x; return at(0.5) < at(-0.5)"
        self.assertTrue(browser.run(tegl_draw))
        # A saved contour does not know, unless it is told.
        tegl("contour", self.folder / "ras.nii", "--iso", 0, "-o", self.folder / "saved.ply", "-q")
        browser = self.view("saved", self.folder / "saved.ply")
        self.assertEqual(ends(browser), "")
        self.assertIn("are unknown", browser.element("#world").text)
        browser = self.view("told", self.folder / "saved.ply", "--world", "lps")
        self.assertEqual(ends(browser), "RLAPIS")
        self.assertLess(browser.run(side), 0)
        # One that is left-handed is no mirror image: seen from the front and with the head above, right is at the left.
        browser = self.view("left", self.folder / "saved.ply", "--world", "LAS")
        self.assertEqual(ends(browser), "RLPAIS")
        self.assertFalse(browser.run(tegl_draw.replace("at(0.5) < at(-0.5)", "tegl.app.stage.scale[0] > 0")))
        self.assertGreater(browser.run(side), 0)
        x = "return document.querySelectorAll('.axis-label b')[arguments[0]].getBoundingClientRect().x"
        self.assertLess(browser.run(x, 0), browser.run(x, 1))  # R, L
        # What is turned around says so.
        self.assertNotIn("mirror", browser.element("#world").text)
        browser.element("#flip").click()
        self.assertIn("The view is a mirror image", browser.element("#world").text)
        # Worlds that differ are not mixed silently.
        write_nrrd(self.folder / "lps.nrrd", (8, 8, 8), lambda x, y, z: 3 - ((x - 4)**2 + (y - 4)**2 + (z - 4)**2)**0.5,
                   'space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace units: "mm" "mm" "mm"\n')
        self.assertEqual(ends(self.view("lps", self.folder / "lps.nrrd", "--iso", 0)), "RLAPIS")
        browser = self.view("mixed", self.folder / "ras.nii", self.folder / "lps.nrrd", "--iso", 0)
        self.assertEqual(ends(browser), "")
        self.assertIn("different world frames, RAS and LPS", browser.element("#notice").text)
        # Nor has the ocean sides of a patient.
        self.assertEqual(ends(self.open()) + browser.element("#world").text, "")

    def test_the_count_says_that_it_is_of_all_when_clipped(self):
        browser = self.open()
        browser.run("tegl.time = 1; tegl.count()")
        count = browser.element("#count")
        self.assertNotIn("clipping", count.text)
        browser.run("tegl.clip(0, 0.5, 1)")
        self.assertRegex(count.text, r"^[\d\u202f]+ triangles before clipping, from ")
        browser.run("tegl.time = 1.5; tegl.count()")
        self.assertIn(" triangles before clipping, ", count.text)
        browser.element("#unclip").click()
        self.assertNotIn("clipping", count.text)

    def test_what_scripts_ask_for_is_looked_at_and_leaves_the_page_unharmed(self):
        wrong = {"tegl.colorBy('nope')": "tegl.colorBy: 'nope'; expected one of 'plain', 'component', 'track', 'axis0'",
                 "tegl.colorBy()": "tegl.colorBy: undefined; expected one of",
                 "tegl.time = NaN": "tegl.time: NaN; expected a number, from ",
                 "tegl.time = '3'": "tegl.time: '3'; expected a number",
                 "tegl.time = null": "tegl.time: null; expected a number",
                 "tegl.clip(7, 0, 1)": "tegl.clip: 7; expected an axis, 0 to 2 (x, y, z)",
                 "tegl.clip('x', 0, 1)": "tegl.clip: 'x'; expected an axis",
                 "tegl.clip(0, 10, -10)": "tegl.clip: [10,-10]; expected two fractions of the axis from 0 to 1",
                 "tegl.clip(0, 0.8, 0.2)": "tegl.clip: [0.8,0.2]; expected two fractions",
                 "tegl.clip(0)": "tegl.clip: [undefined,undefined]; expected two fractions",
                 "tegl.theme('blue')": "tegl.theme: 'blue'; expected 'light', 'dark'",
                 "tegl.play(1)": "tegl.play: 1; expected true or false"}
        browser = self.open()
        browser.run("tegl.time = 2; tegl.theme('light'); tegl.colorBy('track')")
        state = """tegl.draw();
            return [tegl.time, tegl.count(), tegl.app.isPlaying, document.documentElement.dataset.theme,
                tegl.app.current.source.id, document.getElementById('clips').innerText]"""
        before, picture = browser.run(state), self.picture()
        for call, text in wrong.items():
            said = browser.run(f"try {{ {call} }} catch (error) {{ return [error instanceof Error, error.message] }}")
            self.assertTrue(said and said[0] and said[1].startswith(text), (call, said))
            self.assertEqual(browser.run(state), before, call)
        self.assertEqual(self.different(picture, self.picture()), 0)
        browser.run("tegl.play(); tegl.play(false); tegl.theme('dark'); tegl.time = 1e9")
        self.assertEqual(browser.run("return tegl.time === tegl.range[1]"), True)
        # Nor has a page without time one to set.
        tegl("slice", self.folder / "balls.vtkhdf", "--at", "t=1", "-o", self.folder / "still.ply", "-q")
        browser = self.view("still", self.folder / "still.ply")
        for call in ("tegl.time = 1", "tegl.play(true)"):
            self.assertIn("expected a page with a 4D contour", browser.run(f"try {{ {call} }} catch (error) {{ return error.message }}"))

    def test_the_screenshot_is_a_png_of_the_canvas(self):
        browser = self.open()
        browser.element("#shot").click()
        end = time.monotonic() + 20
        while not (saved := list(self.downloads.glob("*.png"))):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.02)
        rows = pixels(saved[0].read_bytes())
        self.assertEqual([len(rows[0]), len(rows)], browser.run("return [tegl.app.stage.canvas.width, tegl.app.stage.canvas.height]"))
        self.assertGreater(self.drawn(rows), 1000)

    def test_three_and_two_dimensions_and_several_files(self):
        tegl("slice", self.folder / "balls.vtkhdf", "--at", "t=1", "-o", self.folder / "apart.ply", "-q")
        tegl("view", self.folder / "apart.ply", "-o", self.folder / "apart.html", "-q")
        browser = self.open("apart.html")
        self.assertGreater(self.drawn(self.picture()), 2000)
        self.assertFalse(browser.element("#time").is_displayed())
        tegl("view", self.folder / "apart.ply", self.folder / "balls.vtkhdf", "-o", self.folder / "both.html", "-q")
        browser = self.open("both.html")
        browser.run("tegl.time = 6")
        both = self.drawn(self.picture())
        browser.element("#layers input").click()
        self.assertLess(self.drawn(self.picture()), both)
        write_nrrd(self.folder / "flat.nrrd", (12, 12), lambda x, y: 4 - ((x - 5.5)**2 + (y - 5.5)**2)**0.5)
        tegl("view", self.folder / "flat.nrrd", "--iso", 0, "-o", self.folder / "flat.html", "-q")
        self.open("flat.html")
        self.assertGreater(self.drawn(self.picture()), 300)

    def test_real_data_have_their_units_and_say_what_is_left_out(self):
        tegl("view", OCEAN, "--iso", 20, "-o", self.folder / "ocean.html", "--limit", 590000, "--tracks", 5, "-q")
        browser = self.open("ocean.html")
        browser.run("tegl.time = 7.25")
        self.assertEqual(browser.element("#now").text.split(), ["time", "7.25", "month", "July"])
        labels = [label.get_attribute("textContent") for label in browser.driver.find_elements("css selector", ".axis-label.name")]
        self.assertEqual(labels, ["lon (degrees_east)", "lat (degrees_north)", "depth (m)"])
        self.assertIn("too large to show all", browser.element("#notice").text)
        self.assertIn("5 of ", browser.element("#graph-note").text)
        # Few are drawn beside those that are cut: between two of twelve months.
        drawn = browser.run("return tegl.draw()")[0]
        self.assertLess(drawn["tetrahedra"], 590000 / 6)
        self.assertLess(drawn["ranges"], 20)
        self.assertGreater(drawn["tetrahedra"], browser.run("return tegl.count()") / 2)

    def test_times_are_the_dates_that_netcdf_means(self):
        meaning = "return new tegl.app.format.constructor({ name: 'time', unit: arguments[0] }, 0, arguments[2]).meaning(arguments[1])"
        browser = self.open()
        for unit, time, text in (
                ("days since 0001-01-01 00:00:00", 730124, "4 Jan 2000"),  # Julian until 1582
                ("days since 1-1-1", 577736, "4 Oct 1582"), ("days since 1-1-1", 577737, "15 Oct 1582"),
                ("days since 1500-2-28", 1, "29 Feb 1500"), ("months since 1950-01-01", 1.5, "15 Feb 1950"),
                ("days since 0000-01-01", 15, "16 Jan"), ("hours since 1900-1-1 00:00:0.0 UTC", 48, "3 Jan 1900"),
                ("days since 0001-01-01 (proleptic_gregorian)", 730122, "4 Jan 2000"), ("weeks since 2000-01-01 (standard)", 1, "8 Jan 2000"),
                ("days since 2000-01-01 (noleap)", 3, ""), ("fortnights since 2000-01-01", 3, ""),
                ("days since 2000-01-01 CET", 3, ""), ("days", 3, "")):
            self.assertEqual(browser.run(meaning, unit, time, 1000000), text, (unit, time))
        for unit, text in (("hours since 2000-01-01 12", "1 Jan 2000, 12:30"),
                           ("hours since 2000-01-01 00:00 +02:00", "31 Dec 1999, 22:30"), ("ms since 2000-01-01 5:30", "1 Jan 2000, 05:30")):
            self.assertEqual(browser.run(meaning, unit, 0.5, 1), text)

    def test_axes_that_point_down_have_their_low_end_above(self):
        for options, is_down in (([], False), (["--down", "z"], True)):
            tegl("view", self.folder / "balls.vtkhdf", *options, "-o", self.folder / "down.html", "-q")
            browser = self.open("down.html")
            low, high = (browser.run("return arguments[0].getBoundingClientRect().y", element) for element in (
                browser.driver.find_elements("css selector", f".axis-label.{end}")[2] for end in ("lowest", "highest")))
            self.assertEqual(low < high, is_down)
            browser.element("#flip").click()
            self.assertEqual(browser.run("return tegl.app.stage.scale[2] < 0"), not is_down)

    def test_titles_say_each_variable_once_with_its_unit(self):
        tegl("contour", self.folder / "balls.nrrd", "--iso", 0.5, "-o", self.folder / "half.vtkhdf", "-q")
        tegl("view", self.folder / "balls.vtkhdf", self.folder / "half.vtkhdf", "-o", self.folder / "two.html", "-q")
        self.assertTrue(self.open("two.html").element("#subtitle").text.startswith("isovalue = 0, 0.5 · "))
        tegl("view", OCEAN, "--iso", 27, "-o", self.folder / "warm27.html", "-q")
        self.assertTrue(self.open("warm27.html").element("#subtitle").text.startswith("temperature = 27 degC · "))

    def test_the_colors_of_the_first_parts_are_told_apart(self):
        data = self.open().run("return Array.from(tegl.app.layers[0].uniforms.uColors.value.image.data)")
        parts = np.array(data).reshape(2, 256, 4)[1, :10, :3] / 255
        linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
        xyz = linear @ np.array([[0.4339, 0.2126, 0.0178], [0.3762, 0.7152, 0.1095], [0.1899, 0.0722, 0.8730]])
        x, y, z = np.cbrt(xyz).T  # CIE 1976, but for the darkest
        lab = np.stack([116 * y, 500 * (x - y), 200 * (y - z)], axis=1)
        apart = np.linalg.norm(lab[:, None] - lab, axis=2)[~np.eye(10, dtype=bool)]
        self.assertGreater(apart.min(), 30)

    def test_a_page_that_is_cut_off_says_so(self):
        whole = (self.folder / "balls.html").read_text(encoding="utf-8")
        for start in ("--ground", 'id="scene">', 'id="numbers">', "</script>\n<script>\n"):
            (self.folder / "cut.html").write_text(whole[:whole.rindex(start) + len(start) + 100], encoding="utf-8")
            self.assertIn("cut off", self.browser.open(self.folder / "cut.html"), start)
            self.assertIn("cut off", self.browser.element("body").text, start)
        (self.folder / "cut.html").write_text(whole.replace("</script>\n<script>\n", "</script>\n<script>\n)(", 1), encoding="utf-8")
        self.assertIn("expected a newer one", self.browser.open(self.folder / "cut.html"))
        self.browser.errors()

    def test_says_so_where_the_browser_cannot_show_it(self):
        with Browser(CHROMIUM, CHROMEDRIVER, gpu=["--disable-gpu", "--disable-3d-apis"]) as blind:
            blind.open(self.folder / "balls.html")
            self.assertIn("WebGL 2", blind.element("#fatal").text)
            self.assertTrue(blind.element("#fatal").is_displayed())
            blind.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument",
                                         {"source": "delete window.DecompressionStream"})
            self.assertIn("DecompressionStream", blind.open(self.folder / "balls.html"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]], verbosity=2)
