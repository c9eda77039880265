# SPDX-License-Identifier: BSD-3-Clause
"""Long calls: progress, Ctrl-C, threads, memory."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
import tegl
from conftest import assert_same, noise


@pytest.fixture(scope="module")
def long_image():
    """Takes a second or so on one thread."""
    return noise((12, 40, 40, 40), 3)


def test_progress_rises(long_image):
    fractions = []
    contour = tegl.contour(long_image, 0.0, threads=1, progress=fractions.append)
    assert len(contour.simplices) > 0
    assert len(fractions) > 3
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] <= 1


def test_a_progress_function_that_says_false_ends_the_work(long_image):
    calls = []

    def stop(fraction):
        calls.append(fraction)
        return False

    with pytest.raises(tegl.Cancelled, match="cancelled"):
        tegl.contour(long_image, 0.0, threads=1, progress=stop)
    assert len(calls) == 1
    assert issubclass(tegl.Cancelled, RuntimeError)


def test_what_a_progress_function_raises_reaches_the_caller(long_image):
    class Mine(Exception):
        pass

    def fail(fraction):
        raise Mine(f"at {fraction}")

    with pytest.raises(Mine, match="at 0"):
        tegl.contour(long_image, 0.0, threads=2, progress=fail)
    contour = tegl.contour(long_image[:4, :25, :25, :25], 0.0, dtype=np.float64)
    for call in (contour.track, contour.measure, contour.components, lambda **k: contour.simplify(ratio=0.5, **k),
                 lambda **k: tegl.Index(long_image, "span-space", **k)):
        with pytest.raises(Mine):
            call(threads=1, progress=fail)


def test_all_long_calls_tell_progress_that_rises_to_one(long_image, tmp_path):
    contour = tegl.contour(long_image[:6, :20, :20, :20], 0.0, dtype=np.float64)
    contour.save(tmp_path / "c.vtkhdf")
    components = contour.components()
    for call in (contour.track, contour.measure, contour.components, contour.elements, contour.check,
                 contour.intersections, components.split,
                 lambda **k: components.select([0, 1], **k), lambda **k: components.largest(2, **k),
                 lambda **k: contour.slice([1.5, 2.5], **k), lambda **k: contour.measure(**k),
                 lambda **k: tegl.measure(contour, at=[1.5, 2.5], **k), lambda **k: tegl.Incidence(contour, **k),
                 lambda **k: tegl.slice(long_image, 0.0, at=[1.5, 2.5], **k),
                 lambda **k: tegl.load(tmp_path / "c.vtkhdf", **k), lambda **k: tegl.Index(long_image, **k),
                 lambda **k: tegl.Index(long_image, "full-scan").pick((6, 20, 20, 20), 0.0, **k)):
        told = []
        call(progress=told.append)
        assert told == sorted(told) and told[-1] == 1.0, (call, told)


@pytest.mark.parametrize("name", ["check", "split", "select", "load"])
def test_what_has_no_events_of_its_own_can_be_cancelled_too(name, tmp_path):
    contour = tegl.contour(noise((6, 24, 24, 24), 1), 0.0)
    components = contour.components()
    contour.save(tmp_path / "c.vtkhdf")
    call = {"check": contour.check, "split": components.split, "select": lambda **k: components.select([0], **k),
            "load": lambda **k: tegl.load(tmp_path / "c.vtkhdf", **k)}[name]
    with pytest.raises(tegl.Cancelled):
        call(progress=lambda fraction: False)


def test_what_is_too_large_is_an_overflow_error():
    everywhere = np.broadcast_to(np.float32(1), (2000, 2000, 2000))  # 2**33 samples, all in one place
    with pytest.raises(OverflowError, match="expected at most 2\\^32"):
        tegl.Index(everywhere, "span-space")


def run_until_interrupted(work, after=0.3):
    """Runs Python code that prints "ready" and goes to work; interrupts it; (seconds until it ended, its output)."""
    code = textwrap.dedent("""
        import signal, sys
        import numpy as np, tegl
        signal.signal(signal.SIGINT, signal.default_int_handler)
        image = np.random.default_rng(1).normal(size=(48, 48, 48, 48)).astype(np.float32)
        print("ready", flush=True)
        try:
            %s
            print("done")
        except KeyboardInterrupt:
            print("interrupted")
        """) % work
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    time.sleep(after)
    child.send_signal(signal.SIGINT)
    start = time.monotonic()
    output = child.stdout.read()
    seconds = time.monotonic() - start
    assert child.wait(30) == 0
    return seconds, output


@pytest.mark.parametrize("work", ["tegl.contour(image, 0.0, threads=1)",
                                  "while True: tegl.contour(image, 0.0)",  # which many threads do quickly
                                  "tegl.contour(image, 0.0, threads=1, ambiguity='saddle', progress=lambda f: None)"])
def test_ctrl_c_ends_a_running_extraction(work):
    seconds, output = run_until_interrupted(work)
    assert output == "interrupted\n"
    assert seconds < 2  # 0.1 s on a machine with nothing else to do


def test_other_threads_of_python_go_on(long_image):
    ticks, stop = [0], threading.Event()

    def tick():
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    tegl.contour(long_image, 0.0, threads=1)
    during = ticks[0]
    stop.set()
    thread.join()
    assert during > 10


def test_two_threads_extract_at_the_same_time(long_image):
    image = long_image[:, :20, :20]
    expected = [tegl.contour(image, level) for level in (0.0, 0.5)]
    found = [None] * 6

    def extract(number):
        told = []
        found[number] = tegl.contour(image, (0.0, 0.5)[number % 2], progress=told.append)

    threads = [threading.Thread(target=extract, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number, contour in enumerate(found):
        assert_same(contour, expected[number % 2])


def test_the_array_is_not_copied_in_memory_either():
    code = textwrap.dedent("""
        import resource
        import numpy as np, tegl
        image = np.ones((300, 400, 800), dtype=np.uint16)[::-1, :, ::2]  # 192 MB of which every other sample counts
        image[100:140, 100:140, 100:140] = 0
        tegl.contour(image[:10], 0.5, allow_empty=True)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        contour = tegl.contour(image, 0.5)
        assert len(contour.simplices) > 10000
        print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
        """)
    megabytes = int(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)
    assert megabytes < 64


def test_memory_that_runs_out_is_a_memory_error():
    code = textwrap.dedent("""
        import resource
        import numpy as np, tegl
        image = np.random.default_rng(1).normal(size=(40, 40, 40, 40)).astype(np.float32)
        tegl.contour(image[:4], 0.0, threads=1)
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + 50_000_000,) * 2)
        try:
            tegl.contour(image, 0.0, threads=1)
        except MemoryError:
            print("MemoryError")
        """)
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
    assert done.stdout == "MemoryError\n", done.stderr
