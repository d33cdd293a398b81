"""Whatever is wrong is an exception with the library's words, never an abort or a hang."""

import subprocess
import sys
import threading

import numpy as np
import pytest

import apertura as ap

SMALL = ap.Radar(elements=64, end_elements=8, samples=32)
ENDS = ap.Scene.of_points([[0.1, 1.2]], SMALL).simulate().ends


def reconstruct(ends):
    return ap.method("capon").reconstruct(ends, SMALL)


@pytest.mark.parametrize(
    "ends, words",
    [
        (ENDS[:, :, :-1], "expected [2, 8, 32]"),
        (ENDS[0], "expected [2, 8, 32]"),
        (ENDS[None], "expected [2, 8, 32]"),
        (np.zeros((0, 0, 0)), "expected [2, 8, 32]"),
        (np.array(3.0), "expected [2, 8, 32]"),
        ("text", "dtype"),
        (np.full((2, 8, 32), None), "dtype is object"),
        (np.full((2, 8, 32), np.nan), "not finite"),
        (np.where(ENDS == ENDS[1, 2, 3], np.inf, ENDS), "sample 3 of element 2 of the last end is not finite"),
    ],
)
def test_unusable_samples_are_told(ends, words):
    with pytest.raises(ValueError) as told:
        reconstruct(ends)
    assert words in str(told.value)


def test_any_layout_of_memory_gives_the_same_answer():
    expected = reconstruct(ENDS).map
    wide = np.zeros((4, 16, 64), complex)
    wide[::2, ::2, ::2] = ENDS
    for ends in (wide[::2, ::2, ::2], np.asfortranarray(ENDS), ENDS[:, :, ::-1][:, :, ::-1], list(ENDS), ENDS.astype(">c16")):
        assert np.array_equal(reconstruct(ends).map, expected)
    single = reconstruct(ENDS.astype(np.complex64)).map
    assert single.shape == expected.shape


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ap.Radar(samples=0), "radar.samples is 0"),
        (lambda: ap.Radar(carrier_hz=float("nan")), "carrier_hz"),
        (lambda: ap.Radar(elements=65536, samples=65536), "too much memory"),
        (lambda: ap.Radar(carrier="sideways"), "one-way or two-way"),
        (lambda: ap.Radar(transmitter_x_metres=[0.0]), "expected both or neither"),
        (lambda: ap.Radar(transmitter_x_metres=[0.0, 1.0], receiver_x_metres=[0.0, 0.1, 0.237]), "off the even line"),
        (lambda: ap.Radar(transmitter_x_metres=[0.0, 1.0], receiver_x_metres=[0.0, 0.1], elements=4), "expected neither"),
        (lambda: ap.Radar(transmitter_y_metres=[0.0]), "belong to lists of x"),
        (
            lambda: ap.Radar(transmitter_x_metres=[0, 0.008], receiver_x_metres=[0, 0.002, 0.004, 0.006], receiver_y_metres=[0.1]),
            "receiver_y_metres has 1 numbers; expected 4",
        ),
        (lambda: ap.Radar(convention="sideways"), "expected thesis or physical"),
        (lambda: ap.Radar(convention="physical", carrier="one-way"), "two-way"),
        (lambda: ap.Scene([ap.Point(float("nan"), 1.0)]), "object 1 (point): x_metres is NaN"),
        (lambda: ap.Scene([ap.Line(0.0, 1.0, 0.1, 10**9)]), "at most 200000"),
        (lambda: ap.Scene.of_points(np.zeros((3, 5))), "expected [reflectors, 2] or [reflectors, 3]"),
        (lambda: ap.Scene.of_points([1.0, 2.0]), "expected [reflectors, 2]"),
        (lambda: ap.Scene.of_points([[1j, 2.0]]), "dtype is complex128"),
        (lambda: ap.Scene.random("7"), "7"),
        (lambda: ap.Scene.random("3", purpose="fun"), "training, validation or test"),
        (lambda: ap.Scene.preset("nowhere"), "expected street"),
        (lambda: ap.Scene.from_toml("name = 3"), "line 1"),
        (lambda: ap.Scene().simulate(floor="rock"), 'unknown floor "rock"'),
        (lambda: ap.Scene().simulate(normalisation="rock"), 'unknown normalisation "rock"'),
        (lambda: ap.method("magic"), 'unknown method "magic"; known: baseline'),
        (lambda: ap.method("live").reconstruct(ENDS, SMALL), "live"),
        (lambda: ap.metrics(np.zeros((2, 2)), np.zeros((2, 3)), 0.5), "expected [2, 2], the target's"),
        (lambda: ap.metrics(np.zeros((0, 2)), np.zeros((0, 2)), 0.5), "at least one cell"),
        (lambda: ap.metrics(np.full((2, 2), np.nan), np.zeros((2, 2)), 0.5), "finite numbers only"),
        (lambda: ap.maps(np.zeros((3, 3)), SMALL), "expected [64, 32]"),
        (lambda: ap.maps(np.full((64, 32), np.nan), SMALL), "not finite"),
        (lambda: ap.cramer_rao(np.zeros((0, 2)), 20), "expected 1 to 64"),
        (lambda: ap.cramer_rao([[0.0, 5.0], [0.0, 5.0]], 20), "don't determine"),
        (lambda: ap.evaluate(["baseline", "baseline"], [1], count=1), "given twice"),
        (lambda: ap.evaluate(["baseline"], [1], count=0), "at least 1"),
        (lambda: ap.torch.Scenes("1=0"), "above 0"),
        (lambda: ap.torch.Scenes("1", thermal=(0.5, 60, 10)), "rising order"),
        (lambda: ap.torch.Scenes("1", length=0), "length is 0"),
        (lambda: ap.set_threads(0), "1 to 1024"),
    ],
)
def test_unusable_values_are_told(make, words):
    with pytest.raises(ValueError) as told:
        make()
    assert words in str(told.value)


def test_what_is_no_object_is_told():
    with pytest.raises(TypeError, match="object 1 is a int; expected Point, Line, Cluster, Wall, Box, Post or Polygon"):
        ap.Scene([3])
    with pytest.raises(TypeError, match="x_metres is 'far'; expected a number"):
        ap.Scene([ap.Point("far", 1.0)])


def test_files_that_are_not_there_are_told(tmp_path):
    for read in (ap.Scene.load, ap.Recording.load, ap.read_rows):
        with pytest.raises(FileNotFoundError, match="nothing.toml"):
            read(tmp_path / "nothing.toml")
    with pytest.raises(OSError, match="scene.toml"):
        ap.Scene().save(tmp_path / "no" / "folder" / "scene.toml")
    (tmp_path / "bad.toml").write_text("name = 3")
    with pytest.raises(ValueError, match="bad.toml: line 1"):
        ap.Scene.load(tmp_path / "bad.toml")
    with pytest.raises(ValueError, match=".toml or .npz"):
        ap.Scene().save(tmp_path / "scene.yaml")


def test_a_full_disk_is_told():
    with pytest.raises(OSError):
        ap.evaluate(["baseline"], [1], count=1, path="/dev/full/rows.csv")


def test_what_a_callback_raises_comes_out():
    def stop(_):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        ap.evaluate(["baseline"], [1], count=50, on_row=stop)
    assert reconstruct(ENDS).map.shape == (32, 64)


def test_threads_that_call_at_once_get_the_same_answers():
    maps = ap.Scene.of_points([[0.1, 1.2]], SMALL).simulate()
    expected = reconstruct(maps.ends).map
    found, method = [], ap.method("capon")

    def work():
        for _ in range(5):
            found.append((method.reconstruct(maps.ends, SMALL).map, maps.target, maps.decades))

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert len(found) == 40 and all(np.array_equal(answer, expected) for answer, _, _ in found)
    assert all(np.array_equal(target, maps.target) for _, target, _ in found)


def test_an_object_may_be_deleted_while_a_thread_uses_it():
    box = {"ends": ENDS.copy(), "method": ap.method("capon")}
    answers = []
    thread = threading.Thread(target=lambda: answers.append(box["method"].reconstruct(box["ends"], SMALL)))
    thread.start()
    box.pop("ends", None)
    box.pop("method", None)
    thread.join(60)
    assert not thread.is_alive()


def test_an_array_that_changes_meanwhile_was_copied():
    ends = ENDS.copy()
    done = []
    thread = threading.Thread(target=lambda: done.append(reconstruct(ends)))
    thread.start()
    for _ in range(100):
        ends *= 1.0
    thread.join(60)
    assert len(done) == 1


SMALL_DISK = """
import os, resource, signal, sys
import apertura as ap
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, 1 << 16))
rows = ap.evaluate(["baseline"], ["1"], count=1)
for write in (
    lambda: ap.dataset("data", [1], count=1),
    lambda: ap.write_rows("rows.csv", rows * 1 + [{**rows[0], "index": i} for i in range(1, 2000)]),
    lambda: ap.Scene.of_points([[1.0, 2.0 + 0.001 * i] for i in range(5000)]).save("scene.toml"),
):
    try:
        write()
    except OSError as error:
        print("told:", error)
print(sorted(name for _, _, names in os.walk(".") for name in names))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such limits")
def test_a_disk_without_room_is_told_and_leaves_no_part(tmp_path):
    found = subprocess.run([sys.executable, "-c", SMALL_DISK], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    lines = found.stdout.splitlines()
    assert found.returncode == 0 and [line[:5] for line in lines[:3]] == ["told:"] * 3, found
    assert "rows.csv" in lines[1] and "scene.toml" not in lines[3] and "rows.csv" not in lines[3]


@pytest.mark.parametrize(
    "ends",
    [ENDS[:, :, :-1], ENDS[0], np.zeros((0, 0, 0)), np.full((2, 8, 32), None), np.full((2, 8, 32), np.nan), "text"],
)
def test_unusable_samples_have_no_input(ends):
    with pytest.raises(ValueError):
        ap.live_input(ends, SMALL)


def test_the_live_network_s_input_is_for_its_radar():
    with pytest.raises(ValueError, match="live"):
        ap.live_input(ENDS, SMALL)
    ends = ap.Scene.of_points([[0.0, 9.0]]).simulate().ends
    strided = np.zeros((2, 24, 512), complex)
    strided[:, ::2] = ends
    one, other = ap.live_input(ends), ap.live_input(strided[:, ::2])
    assert all(np.array_equal(one[name], other[name]) for name in one)
