"""The dataset for PyTorch."""

import json
import multiprocessing
import pickle

import numpy as np
import pytest

import apertura as ap

MIXTURE = "1=1,2=2,3=1"


def test_an_example_is_a_function_of_its_number():
    data = ap.torch.Scenes(MIXTURE, seed=4, length=100, thermal=(0.5, 10, 60))
    first = data.arrays(7)
    other = ap.torch.Scenes(MIXTURE, seed=4, length=50, thermal=(0.5, 10, 60))
    other.arrays(3)
    again = other.arrays(7)
    assert first.keys() == again.keys()
    assert all(np.array_equal(first[name], again[name]) for name in first)
    assert not np.array_equal(first["ends"], ap.torch.Scenes(MIXTURE, seed=5).arrays(7)["ends"])
    assert np.array_equal(pickle.loads(pickle.dumps(data)).arrays(7)["fine"], first["fine"])


def assert_alike(found, decades):
    """Down to eight decades below the peak: far below, without noise, cells are the rounding of the transforms."""
    assert np.abs(found - decades)[decades > decades.max() - 8].max() < 1e-4


def test_an_example_is_its_scene():
    data = ap.torch.Scenes("2", seed=4)
    example = data.arrays(6)
    maps = ap.Scene.random("2", 4, 6, purpose="training").simulate()
    scale = 10 ** -example["gain"]
    assert np.allclose(example["ends"], maps.ends * scale, rtol=1e-6, atol=1e-6)
    assert np.abs(example["target_measured"] - (maps.decades - example["gain"])).max() < 1e-5
    ideal = ap.Scene.random("2", 4, 6, purpose="training").simulate(floor="exact")
    assert_alike(example["target_ideal"] + example["gain"], ideal.decades)
    assert np.mean(np.abs(example["ends"]) ** 2) == pytest.approx(1, rel=1e-5)


def test_the_world_trains_and_validates_and_makes_no_tests():
    data = ap.torch.Scenes("world", seed=4, radar="random")
    found = data.arrays(3)
    assert found["kind"] == "world" and found["constants"].shape == (6,)
    alone = ap.torch.Scenes("world", seed=4, radar=found["radar"]).arrays(3)
    assert all(np.array_equal(found[name], alone[name]) for name in ("ends", "fine", "constants", "target_ideal", "target_measured"))
    ap.torch.Scenes("world", purpose="validation")
    with pytest.raises(ValueError, match="world makes no scenes for tests"):
        ap.torch.Scenes("world", purpose="test")
    with pytest.raises(ValueError, match="world makes no scenes for tests"):
        ap.Scene.random("world")
    assert ap.Scene.random("world", 4, 3, purpose="training") == ap.Scene.random("world", 4, 3, purpose="training")


def test_examples_know_the_radars_that_they_train_for():
    assert not ap.torch.Scenes("2").arrays(0)["constants"].any()
    assert "radar" in json.loads(ap.torch.Scenes("2").domain)
    assert json.loads(ap.torch.Scenes("2", radar="random").domain)["limits"]["carrier_hz"] == [20e9, 100e9]
    with pytest.raises(ValueError, match='radar is 76; expected a Radar, "random" or None'):
        ap.torch.Scenes("2", radar=76)
    assert ap.torch.Scenes("2", radar=ap.Radar(samples=256), network="live").arrays(0)["fine"].shape == (4, 256, 256)
    for make in (lambda: ap.torch.Scenes("street", radar="random"), lambda: ap.Scene.random("street", radar=ap.Radar.preset("chip-8"))):
        with pytest.raises(ValueError, match="scenes of street need a radar that sees 20 m far"):
            make()


def total(index):
    return float(DATA.arrays(index)["fine"].sum())


DATA = ap.torch.Scenes(MIXTURE, seed=4, length=4)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_make_the_same_examples(method):
    expected = [total(index) for index in range(4)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(total, range(4)).get(120) == expected


def test_numbers_beyond_the_end_are_told():
    data = ap.torch.Scenes("1", length=5)
    assert len(data) == 5 and np.array_equal(data.arrays(-1)["rows"], data.arrays(4)["rows"])
    with pytest.raises(IndexError, match="there are 5"):
        data.arrays(5)
    with pytest.raises(TypeError):
        data.arrays(1.5)


def test_more_than_a_batch_at_once_is_told():
    with pytest.raises(ValueError, match="5000 examples are asked for; at most 4096"):
        ap.Examples("1").batch([0] * 5000)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_workers_give_the_same_examples(method):
    torch = pytest.importorskip("torch")
    data = ap.torch.Scenes(MIXTURE, seed=4, length=8)
    expected = [data[i] for i in range(8)]
    assert expected[0]["fine"].dtype == torch.float32 and expected[0]["ends"].dtype == torch.complex64
    loader = torch.utils.data.DataLoader(data, batch_size=2, num_workers=2, multiprocessing_context=method, timeout=120)
    for number, batch in enumerate(loader):
        assert batch["target_measured"].shape == (2, 512, 1024)
        for k in range(2):
            assert all(torch.equal(batch[name][k], expected[2 * number + k][name]) for name in expected[0])


def test_a_dataset_without_workers_works():
    torch = pytest.importorskip("torch")
    loader = torch.utils.data.DataLoader(ap.torch.Scenes("1", length=3), batch_size=3)
    assert [batch["coarse"].shape for batch in loader] == [(3, 10, 512, 64)]


def test_a_bare_target_raises_with_both_names():
    example = ap.torch.Scenes("1", targets=["measured"], radar=CHIP).arrays(0)
    with pytest.raises(KeyError, match="target_ideal .* or target_measured .*this example has target_measured"):
        example["target"]
    with pytest.raises(ValueError, match="target_ideal .* or target_measured"):
        ap.torch.Scenes("1", targets=["target"])
    with pytest.raises(ValueError, match='targets has "ideal" twice'):
        ap.torch.Scenes("1", targets=["ideal", "target_ideal"])


#: A radar of another shape, whose columns fall with cos(theta).
CHIP = ap.Radar(elements=86, end_elements=8, samples=128, convention="physical")


def test_another_radar_has_examples_of_its_shape():
    data = ap.torch.Scenes("2", seed=3, radar=CHIP, floor="snr=20", elements=(1.0, 0.5, 5.0, 0.0), targets=["ideal", "measured", "calibrated"])
    example = data.arrays(0)
    assert example["ends"].shape == (2, 8, 128) and example["radar"] == CHIP and "fine" not in example
    assert {example[f"target_{name}"].shape for name in ("ideal", "measured", "calibrated")} == {(128, 86)}
    # Left is left in targets; a map in the radar's own order has its columns turned.
    scene = ap.Scene.random("2", 3, 0, purpose="training", radar=CHIP)
    decades = scene.simulate(floor="exact").decades[:, CHIP.rising_columns]
    assert_alike(example["target_ideal"] + example["gain"], decades)
    assert np.array_equal(np.arange(86)[CHIP.rising_columns][CHIP.rising_columns], np.arange(86))


def street(random, radar):
    return ap.Scene([ap.Point(x, 5.0) for x in random.uniform(-3, 3, 4)], radar=radar)


def weighed(example):
    return {**example, "weight": 2.0}


def test_scenes_and_examples_of_functions():
    data = ap.torch.Scenes(seed=2, radar=CHIP, scene=street, transform=weighed, length=4)
    example = data.arrays(1)
    assert example["kind"] == "own" and np.array_equal(example["ends"], pickle.loads(pickle.dumps(data)).arrays(1)["ends"])
    assert not np.array_equal(example["ends"], data.arrays(2)["ends"])
    scene = street(np.random.default_rng([2, 0, 1]), CHIP).simulate(floor="exact")
    assert_alike(example["target_ideal"] + example["gain"], scene.decades[:, CHIP.rising_columns])
    with pytest.raises(ValueError, match="example 0: scene returned None; expected a Scene"):
        ap.torch.Scenes(scene=lambda random, radar: None).arrays(0)
    pytest.importorskip("torch")
    assert data[1]["weight"] == 2.0 and data[1]["target_measured"].shape == (128, 86)


def test_the_elements_of_a_layout_are_heard():
    nested = [0, 1, 2, 3, 20, 40, 60, 85]
    example = ap.torch.Scenes("2", seed=3, radar=CHIP, layout=nested).arrays(0)
    samples = ap.Scene.random("2", 3, 0, purpose="training", radar=CHIP).simulate().samples[nested]
    assert example["heard"].shape == (8, 128) and "ends" not in example
    assert np.allclose(example["heard"], samples * 10 ** -example["gain"], rtol=1e-5, atol=1e-6)
    with pytest.raises(ValueError, match="element 86; the radar has elements 0 to 85"):
        ap.torch.Scenes("2", radar=CHIP, layout=[0, 86])
    with pytest.raises(ValueError, match="hears two ends"):
        ap.torch.Scenes("2", layout=[0, 1], network="live")
