"""Arguments that can't be used are named, with what was expected."""

import numpy as np
import pytest

import apertura as ap

NEAR = ap.Radar(bandwidth_hz=8e9)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ap.evaluate("live", ["3"]), "methods is 'live'; expected a list of methods, as in ['live']"),
        (lambda: ap.evaluate(["baseline"], "3"), "scenes is '3'; expected a list of kinds or of Scenes"),
        (lambda: ap.evaluate([5], ["3"]), "methods[0] is 5; expected a name, a Method, a function or a file of weights"),
        (lambda: ap.evaluate(["baseline"], []), "scenes is empty"),
        (lambda: ap.evaluate(["baseline"], ["3"], seed=-1), "seed is -1; expected a whole number from 0"),
        (lambda: ap.evaluate(["baseline"], ["3"], count=-1), "count is -1"),
        (lambda: ap.evaluate(["baseline"], ["3"], target="target"), "target_ideal"),
        (lambda: ap.evaluate(["baseline"], ["3"], elements=3), "elements is 3; expected an Elements"),
        (lambda: ap.evaluate(["baseline"], ["3"], layout="nested=8"), 'layout: there is no layout "nested=8"'),
        (lambda: ap.evaluate(["baseline"], ["3"], layout=5), "layout is 5; expected a name, or numbers of elements"),
        (lambda: ap.evaluate(["baseline"], ["3"], path="rows.parquet"), "expected a name that ends in .csv"),
        (lambda: ap.torch.Scenes("2", layout=[0.5]), "layout is [0.5]"),
        (lambda: ap.torch.Scenes("2", length="5"), "length is '5'"),
        (lambda: ap.Radar(elements=-1), "elements is -1"),
        (lambda: ap.Radar(carrier=77e9), "carrier is 77000000000.0; expected one-way or two-way: its frequency is carrier_hz"),
        (lambda: ap.Radar(window=3), "window is 3; expected hann or hamming"),
        (lambda: ap.Radar(convention=b"thesis"), "convention is b'thesis'; expected thesis or physical"),
        (lambda: ap.Point("a", 1), "Point: x_metres is 'a'; expected a number"),
        (lambda: ap.Wall(0.0, 5.0, None), "Wall: length_metres is None; expected a number"),
        (lambda: ap.Line(0.0, 1.0, 0.1, 2.5), "Line: count is 2.5; expected a whole number"),
        (lambda: ap.Post(0.0, 1.0, 0.1, name=3), "Post: name is 3; expected a text"),
        (lambda: ap.Mirror(reflection="half"), "Mirror: reflection is 'half'; expected a number"),
        (lambda: ap.serve(3), "function is 3; expected a function of ends and radar"),
        (lambda: ap.set_threads(-1), "count is -1"),
        (lambda: ap.Examples("1").batch([-1]), "indices is -1"),
        (lambda: ap.Examples("2", layout="thinned=8").batch([0], mag_phase=True), "mag_phase is of the two ends"),
        (lambda: ap.benchmark.entry(ap.method("capon"), scenes=0), "scenes is 0; expected 1 to"),
        (lambda: ap.benchmark.entry("capon"), "method is 'capon'; expected a Method"),
        (lambda: ap.campaign.campaign(ap.campaign.Run((len,), ("1",), 1), "rows.csv"), "a campaign's workers start programs"),
        (lambda: ap.evaluate([lambda heard, radar: heard], ["3"]), "Method.of_function(function, name=...)"),
        (lambda: ap.metrics(np.zeros((2, 2)), np.zeros((2, 2)), 200), "eta is 200; expected 0 to 1"),
        (lambda: ap.Scene.random("3", seed=-1), "seed is -1"),
        (lambda: ap.Scene.random("3", index=-1), "index is -1"),
        (lambda: ap.Scene(noise_seed=-1), "noise_seed is -1"),
        (lambda: ap.Scene().simulate(seed=-1), "seed is -1"),
        (lambda: ap.Examples("1", -1), "seed is -1"),
        (lambda: ap.threshold("baseline", seed=-1), "seed is -1"),
        (lambda: ap.robustness(["baseline"], "2", count=0), "count is 0"),
        (lambda: ap.Elements.built(seed=-1), "seed is -1"),
        (lambda: ap.method("capon", weights="x.safetensors"), "weights are for"),
    ],
)
def test_an_argument_is_named(make, words):
    with pytest.raises((ValueError, OSError)) as told:
        make()
    assert words in str(told.value)


def test_a_value_of_the_wrong_type_is_a_type_error():
    for make in (lambda: ap.Radar(carrier=77e9), lambda: ap.Point("a", 1), lambda: ap.serve(3)):
        with pytest.raises(TypeError):
            make()


def test_numbers_of_any_type_make_an_object():
    point = ap.Point(np.float32(0.5), np.int64(2), True)
    assert ap.Scene([point]).objects == [ap.Point(0.5, 2.0, 1.0)]
    assert ap.Radar(carrier=None, window=None, convention=None) == ap.Radar()


def test_a_floor_that_is_no_text_is_named():
    with pytest.raises(TypeError, match="floor"):
        ap.Scene().simulate(floor=20)


@pytest.mark.parametrize("kind", ap.kinds())
@pytest.mark.parametrize("name", ap.Radar.presets())
def test_every_kind_is_drawn_or_refused_before_every_radar(kind, name):
    try:
        ap.Scene.random(kind, radar=ap.Radar.preset(name))
    except ValueError as error:
        assert f"scenes of {kind} need a radar that sees" in str(error)


@pytest.mark.parametrize(
    "make",
    [
        lambda: ap.Scene.random("street", radar=NEAR),
        lambda: ap.evaluate(["baseline"], ["street"], radar=NEAR),
        lambda: ap.threshold("baseline", sets=["street"], radar=NEAR),
        lambda: ap.robustness(["baseline"], "street", radar=NEAR),
        lambda: ap.torch.Scenes("street", radar=NEAR),
    ],
)
def test_a_kind_without_room_is_named_with_its_range(make):
    with pytest.raises(ValueError, match="scenes of street need a radar that sees 20 m far; this one sees 9.6 m"):
        make()


def test_metrics_refuse_decades_and_bytes():
    maps = ap.Scene.random("2").simulate()
    for wrong in (maps.decades, 255 * maps.target):
        for take in (lambda a, b: ap.metrics(a, b, 0.5), ap.roc):
            with pytest.raises(ValueError, match="expected Lambda, 0 to 1: decades d become it by"):
                take(maps.target, wrong)
            with pytest.raises(ValueError, match="target: "):
                take(wrong, maps.target)
    decades = maps.decades
    again = (decades - decades.min()) / (decades.max() - decades.min())
    assert ap.metrics(maps.target, again, 0.5).squared_error < 1e-6


def test_kinds_are_those_that_scenes_know():
    assert ap.kinds()[:3] == ["1", "2", "3"] and "street" in ap.kinds() and "world" not in ap.kinds()
    assert ap.kinds(training=True) == [*ap.kinds(), "world"]
    with pytest.raises(ValueError, match=", ".join(ap.kinds()[3:])):
        ap.Scene.random("hills")
    assert np.isfinite(ap.Scene.random(ap.kinds()[0]).reflectors).all()
