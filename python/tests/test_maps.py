"""Simulation, maps, methods and figures."""

import gc

import numpy as np
import pytest

import apertura as ap

SMALL = ap.Radar(elements=64, end_elements=8, samples=32)


def simulated(floor="thesis"):
    return ap.Scene.of_points([[0.1, 1.2], [0.4, 1.7]], SMALL).simulate(floor=floor)


def test_maps_are_those_of_a_transform_written_out():
    maps = simulated("exact")
    window = np.hanning(32)[None, :]
    profiles = np.fft.fft(maps.samples * window, axis=1, norm="ortho")
    full = np.roll(np.fft.fft(profiles * np.hanning(64)[:, None], axis=0, norm="ortho"), 32, axis=0).T
    assert maps.decades.shape == (32, 64)
    assert np.abs(10**maps.decades - np.abs(full)).max() < 1e-12 * np.abs(full).max()
    stretched = (maps.decades - maps.decades.min()) / np.ptp(maps.decades)
    assert np.abs(maps.target - stretched).max() < 1e-6


def test_the_ends_are_the_outer_elements():
    maps = simulated()
    assert np.array_equal(maps.ends, np.stack([maps.samples[:8], maps.samples[-8:]]))
    assert maps.inputs.shape == (2, 32, 64) and maps.inputs.max() == 1.0


def test_maps_of_samples_are_those_of_the_scene():
    maps = simulated()
    again = ap.maps(maps.samples, SMALL)
    assert np.array_equal(again.target, maps.target) and np.array_equal(again.decades, maps.decades)


@pytest.mark.parametrize("convention", ["thesis", "physical"])
def test_columns_sorted_by_their_cosine_have_left_on_the_left(convention):
    radar = SMALL.replace(convention=convention)
    maps = ap.Scene.of_points([[-0.6, 1.2]], radar).simulate(floor="exact")
    drawn = maps.target[:, np.argsort(radar.cos_theta)]
    column = np.unravel_index(drawn.argmax(), drawn.shape)[1]
    assert np.sort(radar.cos_theta)[column] == pytest.approx(-0.45, abs=0.1) and 0 < column < 32


def test_views_outlive_their_maps():
    target = simulated().target
    expected = simulated().target.copy()
    gc.collect()
    junk = [np.ones((64, 64)) for _ in range(100)]
    assert np.array_equal(target, expected) and len(junk) == 100


def test_views_are_read_only():
    maps = simulated()
    for array in (maps.target, maps.samples):
        with pytest.raises(ValueError):
            array[0, 0] = 3
        with pytest.raises(ValueError):
            array.setflags(write=True)


def test_views_are_not_copies():
    maps = simulated()
    assert np.shares_memory(maps.samples, maps.samples) and np.shares_memory(maps.target, maps.target)
    assert np.shares_memory(maps.decades, maps.decades)


@pytest.mark.parametrize("name", ap.methods())
def test_every_method_answers_by_name(name):
    method = ap.method(name)
    assert method.name == name and method.description and method.told and 0 <= method.eta <= 1
    radar = ap.Radar() if name in ("live", "hybrid", "thesis", "thesis-1", "unet") else SMALL
    scene = ap.Scene.of_points([[0.1, 1.2], [0.4, 1.7]], radar)
    maps = scene.simulate(floor="snr=30")
    found = method.reconstruct(maps.ends, radar, floor="snr=30")
    assert found.map.shape == (radar.samples, radar.elements) and found.map.dtype == np.float32
    assert 0 <= found.map.min() and found.map.max() <= 1
    assert found.reflectors.shape[1] == 3 and found.detections.shape[1] == 4
    figures = ap.metrics(maps.target, found.map, found.eta)
    assert figures.squared_error == pytest.approx(float(((maps.target - found.map).astype(float) ** 2).sum()), rel=1e-5)


def test_the_newton_search_finds_the_points():
    found = ap.method("nomp").reconstruct(simulated("exact").ends, SMALL, floor="exact")
    assert np.abs(np.sort(found.reflectors[:, 0]) - [0.1, 0.4]).max() < 1e-3
    assert found.detections[0, 2] == 0.0


def test_figures_are_hand_counted():
    target, output = [[0.95, 0.2], [1.0, 0.0]], [[0.95, 0.8], [0.5, 0.0]]
    figures = ap.metrics(target, output, 0.7)
    assert (figures.detection, figures.false_alarm) == (0.5, 0.5)
    assert ap.metrics(target, output, 0.9, has_echoes=False).detection is None
    eta, detection, false_alarm = ap.roc(target, output)
    at = int(np.searchsorted(eta, 0.7))
    assert len(eta) == 4097 and (detection[at], false_alarm[at]) == (0.5, 0.5)


def test_bounds_shrink_with_the_noise():
    twenty, forty = (ap.cramer_rao([[5.0, 18.0]], snr)[0] for snr in (20, 40))
    assert twenty.x_metres == pytest.approx(10 * forty.x_metres, rel=1e-6)
    assert ap.cramer_rao([[5.0, 18.0]], 20, layout="full")[0].x_metres < twenty.x_metres


def test_a_place_is_like_itself():
    likeness = ap.ambiguity(0.0, 20.0, [20.0, 21.0], [0.0, 0.1])
    assert likeness.shape == (2, 2) and likeness[0, 0] == pytest.approx(1) and likeness[1, 1] < 0.1


def test_rows_come_one_by_one(tmp_path):
    seen, parts = [], []
    rows = ap.evaluate(["baseline"], [1, "crowd"], count=2, on_row=seen.append, progress=parts.append, path=tmp_path / "rows.csv")
    assert rows == seen and [row["set"] for row in rows] == ["1", "1", "crowd", "crowd"]
    assert parts == [0.25, 0.5, 0.75, 1.0]
    again = ap.read_rows(tmp_path / "rows.csv")
    assert [row["squared_error"] for row in again] == [row["squared_error"] for row in rows]
    assert again[0]["floor"] == "thesis" and again[0]["methods"] == "baseline"


@pytest.mark.parametrize("detector", ["ca:guard=1x1:training=2x3:rate=0.05", "os:guard=1x1:training=2x3:rate=0.05"])
def test_a_detector_keeps_its_rate_on_noise(detector):
    power = np.random.default_rng(3).exponential(size=(200, 256))
    detected = ap.cfar(power, detector)
    assert detected.shape == power.shape and detected.dtype == bool
    assert abs(detected.mean() / 0.05 - 1) < 0.1
    assert (ap.cfar(7e-20 * power, detector) == detected).all()


def test_a_detector_that_can_not_work_is_refused():
    power = np.ones((16, 16))
    for detector, said in [
        ("ca:training=0x0", "no training cells"),
        ("ca:rate=1", "between 0 and 1"),
        ("mean", "expected ca or os"),
        ("ca:training=1x20", "span 41 columns and the map has 16"),
    ]:
        with pytest.raises(ValueError, match=said):
            ap.cfar(power, detector)
    with pytest.raises(ValueError, match="finite numbers from 0"):
        ap.cfar(-power)


def test_rows_tell_what_a_detector_makes_of_an_output():
    rows = [ap.evaluate(["baseline"], ["1"], count=1, cfar=cfar)[0] for cfar in (None, "ca")]
    assert rows[0]["cfar"] == "" and rows[1]["cfar"] == "ca:guard=4x0:training=16x0:rate=0.0001"
    assert 0 < rows[1]["cfar_detection"] <= 1 and 0 <= rows[1]["cfar_false_alarm"] < 1
    assert rows[0]["squared_error"] == rows[1]["squared_error"]


def test_a_range_doppler_map_has_a_point_at_its_velocity():
    radar = SMALL.replace(convention="physical", chirps=64)
    most = radar.unambiguous_velocity_metres_per_second
    for velocity, shown in [(0.4 * most, 0.4 * most), (-0.7 * most, -0.7 * most), (1.5 * most, -0.5 * most)]:
        scene = ap.Scene([ap.Point(0.0, 1.2, velocity_y_metres_per_second=velocity)], radar=radar)
        power = ap.range_doppler(scene, floor="exact")
        assert power.shape == (32, 64)
        column = np.unravel_index(power.argmax(), power.shape)[1]
        assert abs(radar.velocity_metres_per_second[column] - shown) < 0.02 * most
        assert scene.objects[0].velocity_y_metres_per_second == velocity
    with pytest.raises(ValueError, match="seconds is NaN"):
        ap.range_doppler(scene, seconds=float("nan"))
    with pytest.raises(ValueError, match="chirps is 0"):
        radar.replace(chirps=0)
    with pytest.raises(ValueError, match="-10000 to 10000 m/s"):
        ap.Scene([ap.Point(0.0, 1.2, velocity_x_metres_per_second=float("inf"))])
