"""Datasets on disk."""

import json
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import apertura as ap

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "set"
    ap.dataset(folder, [3, "clusters"], count=2, validation=1, test=1, seed=4, shard=3)
    return folder


def test_an_example_on_disk_is_that_of_the_dataset_for_pytorch(folder):
    data = ap.data.Files(folder, "train", check=True)
    assert len(data) == 4 and [data.kind(i) for i in range(4)] == ["3", "clusters", "3", "clusters"]
    expected = ap.torch.Scenes("clusters", seed=4).arrays(1)
    found = data[3]
    assert found["ends"].dtype == np.complex128 and np.array_equal(found["ends"].astype(np.complex64), expected["ends"])
    assert found["gain"] == expected["gain"] and np.array_equal(found["scalars"], expected["scalars"])
    for name in ("fine", "coarse", "rows", "target_measured", "target_ideal"):
        assert found[name].dtype == np.float32
        assert np.abs(found[name] - expected[name]).max() <= 1e-3 * np.abs(expected[name]).max(), name


def test_splits_are_of_streams_of_their_own(folder):
    test = ap.data.Files(folder, "test")
    expected = ap.torch.Scenes("3", seed=4, purpose="test").arrays(0)
    assert np.array_equal(test[0]["ends"].astype(np.complex64), expected["ends"])
    assert len(ap.data.Files(folder, "validation")) == 2


def test_a_pickled_dataset_reads_the_same(folder):
    data = ap.data.Files(folder)
    data[0]
    assert np.array_equal(pickle.loads(pickle.dumps(data))[-1]["target_ideal"], data[3]["target_ideal"])


def test_what_is_no_dataset_is_told(folder, tmp_path):
    with pytest.raises(FileNotFoundError, match="written to its end"):
        ap.data.Files(tmp_path)
    (tmp_path / "manifest.json").write_text("[]")
    with pytest.raises(ValueError, match="no manifest"):
        ap.data.Files(tmp_path)
    manifest = json.loads((folder / "manifest.json").read_text())
    (tmp_path / "manifest.json").write_text(json.dumps({**manifest, "apertura_dataset": 9}))
    with pytest.raises(ValueError, match="version 9"):
        ap.data.Files(tmp_path)
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(FileNotFoundError, match="the manifest names it"):
        ap.data.Files(tmp_path)
    with pytest.raises(ValueError, match="expected test, train, validation"):
        ap.data.Files(folder, "exam")
    with pytest.raises(IndexError, match="there are 4"):
        ap.data.Files(folder)[4]


def test_a_changed_file_is_told(folder, tmp_path):
    ap.dataset(tmp_path, [1], count=1, validation=0, test=0, arrays=["ends"])
    path = tmp_path / "train" / "00000.ends.npy"
    bytes = bytearray(path.read_bytes())
    bytes[-1] ^= 1
    path.write_bytes(bytes)
    ap.data.Files(tmp_path)
    with pytest.raises(ValueError, match="SHA-256"):
        ap.data.Files(tmp_path, check=True)
    path.write_bytes(bytes[:-1])
    with pytest.raises(ValueError, match="bytes; the manifest says"):
        ap.data.Files(tmp_path)


@pytest.mark.parametrize(
    "arguments, words",
    [
        ({"sets": ["magic"], "count": 1}, "magic"),
        ({"sets": [], "count": 1}, "nothing to write"),
        ({"sets": [1], "count": 0}, "some for training"),
        ({"sets": [1], "count": 1, "dtype": "f64"}, "expected f16 or f32"),
        ({"sets": [1], "count": 1, "arrays": ["maps"]}, "expected ends, features, target_ideal"),
        ({"sets": [1], "count": 1, "arrays": ["target"]}, "target_ideal"),
        ({"sets": [1], "count": 1, "shard": 0}, "1 to 4096"),
        ({"sets": [1], "count": -1}, "count is -1"),
        ({"sets": [1], "count": 1, "seed": -1}, "seed is -1"),
        ({"sets": ["street"], "count": 1, "radar": ap.Radar(bandwidth_hz=8e9)}, "scenes of street need a radar that sees 20 m far"),
        ({"sets": [1, "1"], "count": 1}, "given twice"),
    ],
)
def test_requests_that_cannot_be_are_told(tmp_path, arguments, words):
    with pytest.raises(ValueError) as told:
        ap.dataset(tmp_path / "new", **arguments)
    assert words in str(told.value)


def test_a_folder_in_use_is_kept(folder):
    with pytest.raises(ValueError, match="is not empty"):
        ap.dataset(folder, [1], count=1)


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        ap.dataset(tmp_path / "file", [1], count=1)


def test_a_dataset_has_its_radar_and_layout(tmp_path):
    radar = ap.Radar(elements=86, end_elements=8, samples=128)
    layout = [0, 1, 4, 9, 85]
    ap.dataset(tmp_path / "set", [2], count=1, validation=0, test=0, radar=radar, layout=layout, elements=(1.0, 0.5, 5.0, 0.0), dtype="f32")
    files = ap.data.Files(tmp_path / "set")
    expected = ap.torch.Scenes("2", radar=radar, layout=layout, elements=(1.0, 0.5, 5.0, 0.0)).arrays(0)
    assert files.radar(0) == radar and files.manifest["layout"] == layout
    assert np.array_equal(files[0]["heard"].astype(np.complex64), expected["heard"])
    for name in ("target_ideal", "target_measured"):
        assert np.array_equal(files[0][name], expected[name]), name
    with pytest.raises(KeyError, match="target_ideal .* or target_measured"):
        files[0]["target"]


def test_a_dataset_of_random_radars_names_each(tmp_path):
    ap.dataset(tmp_path / "set", ["world"], count=2, validation=0, radar="random", arrays=["ends"])
    files = ap.data.Files(tmp_path / "set")
    assert [files.radar(i) for i in range(2)] == [ap.torch.Scenes("world", radar="random").arrays(i)["radar"] for i in range(2)]


def test_the_documented_loop_learns(folder, tmp_path, monkeypatch, capsys):
    pytest.importorskip("torch")
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "data.md").read_text(), re.DOTALL)
    [loop] = [block for block in blocks if "ap.data.Files" in block]
    assert len(loop.strip().splitlines()) <= 21
    monkeypatch.chdir(tmp_path)
    exec(loop.replace('"target/data"', repr(str(folder))), {})
    losses = [float(loss) for loss in re.findall(r"loss ([\d.]+)", capsys.readouterr().out)]
    assert len(losses) == 2 and losses[1] < losses[0]
    assert (tmp_path / "network.pt").exists()
