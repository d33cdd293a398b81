"""Any wrong value is an exception with the library's words, never an abort or a hang."""

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


MAPS = ap.Scene.of_points([[0.1, 1.2]], SMALL).simulate()
PLACES = [[0.0, 5.0], [3.0, 9.0]]
DETECTOR = "ca:guard=1x1:training=2x3:rate=0.05"

#: Every function that takes an array, with one that it takes.
TAKERS = {
    "maps": (MAPS.samples, lambda array: ap.maps(array, SMALL)),
    "reconstruct": (ENDS, reconstruct),
    "metrics of a target": (MAPS.target, lambda array: ap.metrics(array, MAPS.target, 0.5)),
    "metrics of an output": (MAPS.target, lambda array: ap.metrics(MAPS.target, array, 0.5)),
    "roc of a target": (MAPS.target, lambda array: ap.roc(array, MAPS.target)),
    "roc of an output": (MAPS.target, lambda array: ap.roc(MAPS.target, array)),
    "cfar": (MAPS.target, lambda array: ap.cfar(array, DETECTOR)),
    "cramer_rao": (np.array(PLACES), lambda array: ap.cramer_rao(array, 20)),
    "of_points": (np.array(PLACES), ap.Scene.of_points),
    "ranges of ambiguity": (np.array([19.0, 21.0]), lambda array: ap.ambiguity(0.0, 20.0, array, [0.0, 0.1])),
    "cosines of ambiguity": (np.array([0.0, 0.1]), lambda array: ap.ambiguity(0.0, 20.0, [19.0, 21.0], array)),
    "corners": (np.array([*PLACES, [1.0, 7.0]]), lambda array: ap.Scene([ap.Polygon(array)])),
    "transmitters": (np.array([0.0, 0.1]), lambda array: ap.Radar(transmitter_x_metres=array, receiver_x_metres=[0.0, 0.01, 0.02])),
    "gains": (np.zeros(SMALL.elements), lambda array: elements(gain_db=array)),
    "phases": (np.zeros(SMALL.elements), lambda array: elements(phase_degrees=array)),
}

#: What is made of an array that is taken.
SPOILED = {
    "an axis more": lambda array: array[None],
    "no axis": lambda array: np.array(3.0),
    "NaN": lambda array: spoiled(array, np.nan),
    "infinite": lambda array: spoiled(array, np.inf),
    "objects": lambda array: np.full(array.shape, None),
    "text": lambda array: np.full(array.shape, "x"),
    "dates": lambda array: np.zeros(array.shape, "M8[s]"),
    "records": lambda array: np.zeros(array.shape, [("a", "f4")]),
    "a word": lambda array: "x",
}


def elements(**columns):
    zeros = {name: [0.0] * SMALL.elements for name in ("gain_db", "phase_degrees", "position_millimetres")}
    return ap.Scene([ap.Point(0.1, 1.2)], radar=SMALL, elements=ap.Elements(**{**zeros, **columns})).simulate()


def spoiled(array, value):
    array = np.array(array)
    array.flat[1] = value
    return array


@pytest.mark.parametrize("taker", TAKERS)
@pytest.mark.parametrize("what", SPOILED)
def test_no_array_is_taken_for_another(taker, what):
    array, take = TAKERS[taker]
    take(array)
    with pytest.raises((ValueError, TypeError)):
        take(SPOILED[what](array))


@pytest.mark.parametrize("taker", [name for name in TAKERS if name not in ("of_points", "cfar", "ranges of ambiguity", "cosines of ambiguity")])
def test_an_empty_array_is_told(taker):
    array, take = TAKERS[taker]
    for empty in (np.zeros((0,) * array.ndim), np.zeros((0, *array.shape[1:]))):
        with pytest.raises((ValueError, TypeError)):
            take(empty)


def test_of_nothing_comes_nothing():
    assert len(ap.Scene.of_points(np.zeros((0, 2)))) == 0
    assert ap.cfar(np.zeros((0, 64)), DETECTOR).shape == (0, 64)
    assert ap.ambiguity(0.0, 20.0, [], [0.0, 0.1]).shape == (0, 2)


@pytest.mark.parametrize("taker", TAKERS)
def test_any_layout_of_any_array_is_taken(taker):
    array, take = TAKERS[taker]
    array = np.array(array)
    wide = np.zeros([2 * length for length in array.shape], array.dtype)
    thin = tuple(slice(None, None, 2) for _ in array.shape)
    wide[thin] = array
    as_bytes = lambda found: np.asarray(getattr(found, "target", getattr(found, "map", found)), dtype=object if taker == "cramer_rao" else None)
    expected = as_bytes(take(array))
    for other in (wide[thin], np.asfortranarray(array), array[::-1][::-1], array.astype(array.dtype.newbyteorder(">")), array.tolist()):
        assert np.array_equal(as_bytes(take(other)), expected)


@pytest.mark.parametrize("name", [name for name in ap.methods() if name not in ("live", "thesis", "thesis-1", "unet")])
@pytest.mark.parametrize("scale", [1e300, 1e-300, 0.0])
def test_samples_of_any_size_give_numbers(name, scale):
    found = ap.method(name).reconstruct(ENDS / np.abs(ENDS).max() * scale, SMALL)
    assert np.isfinite(found.map).all() and np.isfinite(found.reflectors).all()


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
        (lambda: ap.Radar(carrier_hz=77), "carrier_hz is 77.0; it must be at least 1e6, in hertz"),
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


@pytest.mark.parametrize(
    "ends",
    [ENDS[:, :, :-1], ENDS[0], np.zeros((0, 0, 0)), np.full((2, 8, 32), None), np.full((2, 8, 32), np.nan), "text"],
)
def test_unusable_samples_have_no_input(ends):
    with pytest.raises(ValueError):
        ap.live_input(ends, SMALL)


def test_the_live_network_s_input_has_the_shape_of_its_radar():
    assert ap.live_input(ENDS, SMALL)["fine"].shape == (4, 32, 256)
    with pytest.raises(ValueError, match="8 samples or more"):
        ap.live_input(ENDS[:, :, :4], SMALL.replace(samples=4))
    ends = ap.Scene.of_points([[0.0, 9.0]]).simulate().ends
    strided = np.zeros((2, 24, 512), complex)
    strided[:, ::2] = ends
    one, other = ap.live_input(ends), ap.live_input(strided[:, ::2])
    assert all(np.array_equal(one[name], other[name]) for name in one)
