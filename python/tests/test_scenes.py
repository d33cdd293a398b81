"""Scenes, radars and their files."""

import pickle

import numpy as np
import pytest

import apertura as ap

ALL_KINDS = [
    ap.Point(-4.0, 12.5, 0.5),
    ap.Line(1.0, 2.0, 0.1, 75, direction_degrees=30.0),
    ap.Cluster(-5.0, 20.0, 1.0, 0.5, 40, seed=9),
]


def disturbed():
    radar = ap.Radar(elements=32, end_elements=6, samples=16)
    elements = ap.Elements.built(gain_db=0.5, phase_degrees=5, seed=3, radar=radar)
    return ap.Scene(
        ALL_KINDS, name="All", notes="Three", noise_seed=7, radar=radar, elements=elements, interferer=ap.Interferer(strength=0.2), mirror=ap.Mirror()
    )


def test_a_scene_keeps_what_it_is_made_of():
    scene = disturbed()
    assert scene.objects == ALL_KINDS and len(scene) == 3
    assert (scene.name, scene.notes, scene.noise_seed) == ("All", "Three", 7)
    assert scene.reflectors.shape == (116, 3) and scene.reflectors[0].tolist() == [-4.0, 12.5, 0.5]
    assert scene.interferer == ap.Interferer(strength=0.2) and scene.mirror == ap.Mirror()
    assert scene.elements is not None and scene.elements.gain_db.shape == (32,)


@pytest.mark.parametrize("scene", [disturbed(), ap.Scene(), ap.Scene.preset("street")])
def test_a_scene_is_read_as_it_was_written(scene, tmp_path):
    scene.save(tmp_path / "scene.toml")
    assert ap.Scene.load(tmp_path / "scene.toml") == scene
    assert ap.Scene.from_toml(scene.to_toml()) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene.replace() == scene


def test_an_npz_keeps_positions(tmp_path):
    ap.Scene(ALL_KINDS).save(tmp_path / "scene.npz")
    again = ap.Scene.load(tmp_path / "scene.npz")
    assert np.array_equal(again.reflectors[:, :2], ap.Scene(ALL_KINDS).reflectors[:, :2])
    assert set(np.load(tmp_path / "scene.npz")) == {"all_point_x", "all_point_y"}


def test_replace_changes_what_it_is_told():
    scene = disturbed().replace(name="Other", mirror=None)
    assert scene.name == "Other" and scene.mirror is None and scene.objects == ALL_KINDS
    assert not ap.Scene(ALL_KINDS, shadows=False).replace(name="Other").shadows
    assert ap.Radar().replace(samples=256) == ap.Radar(samples=256) != ap.Radar()


def test_a_convention_brings_its_carrier_with_its_spacing():
    light = 299_792_458.0
    physical = ap.Radar(convention="physical", bandwidth_hz=1e9)
    assert (physical.convention, physical.carrier) == ("physical", "two-way")
    assert physical.element_spacing_metres == pytest.approx(light / 77.5e9 / 4)
    assert ap.Radar(bandwidth_hz=1e9).replace(convention="physical") == physical
    assert physical.replace(convention="thesis") == ap.Radar(bandwidth_hz=1e9)
    wide = physical.replace(convention="physical", element_spacing_metres=0.002)
    assert (wide.carrier, wide.element_spacing_metres) == ("two-way", 0.002)
    assert ap.Radar.preset("table-3.1-physical") == ap.Radar(convention="physical")


def test_a_budget_is_that_of_the_radar_equation():
    budget = ap.LinkBudget(noise_figure_db=15, half_power_width_degrees=120)
    radar = ap.Radar(budget=budget, chirp_seconds=51.2e-6)
    link = radar.link(50, cross_section_dbsm=10)
    wavelength = 299_792_458.0 / 77e9
    received = 10 ** ((12 + 2 * 10 + 10) / 10) * 1e-3 * wavelength**2 / ((4 * np.pi) ** 3 * 50**4)
    noise = 1.380649e-23 * 290 * 10e6 * 10**1.5
    assert link["sample_snr_db"] == pytest.approx(10 * np.log10(received / noise))
    assert radar.link(50, 10, angle_degrees=60)["sample_snr_db"] == pytest.approx(link["sample_snr_db"] - 6.0206, abs=1e-3)
    assert eval(repr(radar), {"Radar": ap.Radar, "LinkBudget": ap.LinkBudget}) == radar == pickle.loads(pickle.dumps(radar))
    assert ap.Radar(budget={"noise_figure_db": 15, "half_power_width_degrees": 120}).budget == budget != ap.LinkBudget()
    assert ap.Radar().budget is None and ap.LinkBudget.reflectivity_of(20) == pytest.approx(10)
    with pytest.raises(ValueError, match="0 to 100 dB: a receiver adds noise"):
        ap.LinkBudget(noise_figure_db=-3)
    small = ap.Radar(elements=32, end_elements=6, samples=16, budget=ap.LinkBudget())
    assert ap.Scene().simulate(small, floor="thermal").samples.shape == (32, 16)


def test_antennas_say_elements_with_spacing():
    radar = ap.Radar(transmitter_x_metres=[-0.008, 0, 0.008], receiver_x_metres=[0, 0.002, 0.004, 0.006], convention="physical")
    assert (radar.elements, radar.end_elements) == (12, 6)
    assert radar.element_spacing_metres == pytest.approx(0.001)
    assert radar.receiver_x_metres.shape == (4,)
    assert ap.Radar().transmitter_x_metres is None
    assert eval(repr(radar).replace("Radar", "ap.Radar")) == radar == pickle.loads(pickle.dumps(radar))
    assert radar.replace(samples=64).receiver_x_metres.shape == (4,)
    signal = ap.Scene.of_points([[0.1, 1.2]], radar).simulate(floor="exact").samples
    swapped = radar.replace(transmitter_x_metres=radar.receiver_x_metres, receiver_x_metres=radar.transmitter_x_metres)
    heard = ap.Scene.of_points([[0.1, 1.2]], swapped).simulate(floor="exact").samples
    assert np.abs(signal - heard).max() < 1e-11 * np.abs(signal).max()


def test_antennas_stand_off_the_line():
    x = {"transmitter_x_metres": [-0.008, 0, 0.008], "receiver_x_metres": [0, 0.002, 0.004, 0.006]}
    radar = ap.Radar(**x, transmitter_y_metres=[-0.01, 0, -0.01], focus_off_line=True, convention="physical", samples=64)
    assert radar.transmitter_y_metres.tolist() == [-0.01, 0, -0.01] and not radar.receiver_y_metres.any()
    assert eval(repr(radar).replace("Radar", "ap.Radar")) == radar == pickle.loads(pickle.dumps(radar))
    straight = radar.replace(transmitter_y_metres=[0, 0, 0])
    assert straight.element_spacing_metres == radar.element_spacing_metres and ap.Radar().transmitter_y_metres is None
    maps = [ap.Scene.of_points([[1.0, 3.0]], r).simulate(floor="exact") for r in (radar, radar.replace(focus_off_line=False), straight)]
    assert np.array_equal(maps[0].samples, maps[1].samples) and not np.array_equal(maps[0].samples, maps[2].samples)
    focused, nearest, line = (m.decades - m.decades.max() for m in maps)
    strong = line > -1
    assert np.abs(focused - line)[strong].max() < 0.2 * np.abs(nearest - line)[strong].max()


def test_random_scenes_repeat():
    scene = ap.Scene.random(3, seed=7, index=2)
    assert scene == ap.Scene.random("3", 7, 2) != ap.Scene.random("3", 7, 3)
    assert scene != ap.Scene.random("3", 7, 2, purpose="training")
    assert len(ap.Scene.random("noise")) == 0


def test_presets_load():
    assert "street" in ap.Scene.presets() and all(len(ap.Scene.preset(name).name) > 0 for name in ap.Scene.presets())
    assert [ap.Radar.preset(name) for name in ap.Radar.presets()][0] == ap.Radar()
    for name in ap.Recording.presets():
        recording = ap.Recording.preset(name)
        assert recording.samples is not None and recording.samples.shape == (recording.radar.elements, recording.radar.samples)
        assert recording.ends.shape == (2, recording.radar.end_elements, recording.radar.samples)


def test_a_radar_says_its_axes():
    radar = ap.Radar()
    assert repr(radar) == "Radar()" and repr(ap.Radar(samples=256)) == "Radar(samples=256)"
    assert radar.range_metres.shape == (512,) and radar.cos_theta[512] == 0.0
    assert radar.element_x_metres[0] == -radar.element_x_metres[-1]
    assert pickle.loads(pickle.dumps(ap.Radar(window="blackman"))) == ap.Radar(window="blackman")
