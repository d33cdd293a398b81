"""Objects of the compiled module are pickled."""

import pickle

import numpy as np
import pytest

import apertura as ap

RADAR = ap.Radar(elements=64, end_elements=8, samples=32, convention="physical")


def again(thing):
    return pickle.loads(pickle.dumps(thing))


def test_maps_are_the_same_again():
    elements = ap.Elements.built(gain_db=0.5, phase_degrees=5.0, radar=RADAR)
    maps = ap.Scene([ap.Point(0.1, 1.2)], radar=RADAR, elements=elements).simulate(floor="snr=20", normalisation="db=50")
    other = again(maps)
    assert other.radar == maps.radar and other.normalisation == "db=50"
    assert np.array_equal(other.samples, maps.samples) and np.array_equal(other.target, maps.target)


def test_a_reconstruction_is_the_same_again():
    ends = ap.Scene.of_points([[0.1, 1.2]], RADAR).simulate().ends
    for name in ("iaa", "omp"):
        found = ap.method(name).reconstruct(ends, RADAR)
        other = again(found)
        for part in ("map", "reflectors", "confidences", "detections"):
            assert np.array_equal(getattr(other, part), getattr(found, part), equal_nan=True), part
        assert other.eta == found.eta and other.doubt is None
    live = ap.method("live").reconstruct(ap.Scene.random("1").simulate().ends)
    assert np.array_equal(again(live).doubt, live.doubt)


@pytest.mark.parametrize("name", ap.Recording.presets())
def test_a_recording_is_the_same_again(name):
    recording = ap.Recording.preset(name)
    other = again(recording)
    for part in ("name", "notes", "radar", "missing", "range_metres", "doubts", "floor"):
        assert getattr(other, part) == getattr(recording, part), part
    assert np.array_equal(other.ends, recording.ends)
    assert (other.samples is None) == (recording.samples is None)


def test_examples_are_the_same_again():
    examples = ap.Examples("2", 3, radar=RADAR, targets=["ideal"], layout=[0, 3, 9])
    [one], [other] = examples.batch([4]), again(examples).batch([4])
    assert one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in ("heard", "target_ideal"))


def zero(ends, radar):
    return np.zeros((radar.samples, radar.elements))


def test_a_function_as_a_method_is_the_same_again():
    method = again(ap.Method.of_function(zero, eta=0.25, told="nothing"))
    assert (method.name, method.eta, method.told) == ("zero", 0.25, "nothing")


def test_a_complex_map_is_what_numpy_computes():
    maps = ap.Scene.of_points([[0.1, 1.2]], RADAR).simulate()
    hann = lambda n: 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(n) / (n - 1))
    ranges = np.fft.fft(maps.samples * hann(32), axis=1, norm="ortho")
    expected = np.fft.fftshift(np.fft.fft(ranges * hann(64)[:, None], axis=0, norm="ortho"), axes=0).T
    assert np.allclose(maps.complex, expected, atol=1e-9 * np.abs(expected).max())
    assert np.allclose(np.log10(np.abs(maps.complex)), maps.decades, atol=1e-6)


def test_chirps_are_what_range_doppler_is_made_of():
    radar = RADAR.replace(chirps=8, chirp_interval_seconds=5e-5)
    scene = ap.Scene([ap.Point(0.1, 1.2, velocity_y_metres_per_second=5.0)], radar=radar)
    samples = ap.chirp_samples(scene, floor="exact")
    assert samples.shape == (8, 8, 32) and ap.range_doppler(scene, floor="exact").shape == (32, 8)
    still = ap.Scene([ap.Point(0.1, 1.2)], radar=radar)
    rows = [0, 1, 2, 3, 60, 61, 62, 63]
    assert np.allclose(ap.chirp_samples(still, floor="exact")[5], still.simulate(floor="exact").samples[rows], atol=1e-12)
