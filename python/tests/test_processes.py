"""Forked and spawned processes, Ctrl-C, threads of the interpreter."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import apertura as ap

SCENE = ap.Scene.random("2", seed=3)


def mean_target(_=None):
    return float(SCENE.simulate(floor="thesis").target.mean())


def threads_here(_=None):
    return ap.threads()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_forked_process_works_on_one_thread():
    expected = mean_target()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(mean_target, range(4)).get(120) == [expected] * 4
        assert pool.map_async(threads_here, range(2)).get(120) == [1, 1]
    assert mean_target() == expected


def test_a_spawned_process_gives_the_same_bits():
    expected = mean_target()
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply_async(mean_target).get(120) == expected


def test_the_number_of_threads_changes_no_bit():
    before = ap.threads()
    samples = {}
    for count in (1, 3):
        ap.set_threads(count)
        assert ap.threads() == count
        samples[count] = SCENE.simulate().samples.copy()
    ap.set_threads(before)
    assert np.array_equal(samples[1], samples[3])


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_stops_long_work():
    script = textwrap.dedent(
        """
        import signal
        import apertura as ap
        # A shell starts what runs in the background with Ctrl-C ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            ap.evaluate(["baseline"], ["3"], count=100000, on_row=lambda row: print(row["index"], flush=True))
        except KeyboardInterrupt:
            print("stopped", flush=True)
        """
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "0\n"
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=120)
    assert rest.endswith("stopped\n") and process.returncode == 0


def test_other_threads_go_on_while_rust_works():
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.005)

    ends = SCENE.simulate().ends
    thread = threading.Thread(target=tick)
    thread.start()
    began = time.monotonic()
    ap.method("omp").reconstruct(ends)
    ended = time.monotonic()
    stop.set()
    thread.join(30)
    inside = [t for t in ticks if began < t < ended]
    assert len(inside) > 0.1 * (ended - began) / 0.005


def test_progress_rises_to_one():
    parts = []
    ap.method("nomp").reconstruct(SCENE.simulate().ends, progress=parts.append)
    assert parts == sorted(parts) and parts[-1] == 1.0
