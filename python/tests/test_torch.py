"""The dataset for PyTorch."""

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


def test_an_example_is_its_scene():
    data = ap.torch.Scenes("2", seed=4)
    example = data.arrays(6)
    maps = ap.Scene.random("2", 4, 6, purpose="training").simulate()
    scale = 10 ** -example["gain"]
    assert np.allclose(example["ends"], maps.ends * scale, rtol=1e-6, atol=1e-6)
    assert np.abs(example["target"] - (maps.decades - example["gain"])).max() < 1e-5
    assert np.mean(np.abs(example["ends"]) ** 2) == pytest.approx(1, rel=1e-5)


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
        assert batch["target"].shape == (2, 512, 1024)
        for k in range(2):
            assert all(torch.equal(batch[name][k], expected[2 * number + k][name]) for name in expected[0])


def test_a_dataset_without_workers_works():
    torch = pytest.importorskip("torch")
    loader = torch.utils.data.DataLoader(ap.torch.Scenes("1", length=3), batch_size=3)
    assert [batch["coarse"].shape for batch in loader] == [(3, 10, 512, 64)]
