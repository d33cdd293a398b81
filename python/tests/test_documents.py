"""Examples that pages of the project show run as they are."""

import re
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

import apertura as ap

ROOT = Path(__file__).parents[2]


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)


def test_the_example_of_the_readme_runs(monkeypatch, capsys):
    pytest.importorskip("torch")
    [example] = blocks("README.md", "python")
    # The window and the server of a method go on until they are closed: that they are called as they can be is looked at.
    for endless in ["open", "serve"]:
        monkeypatch.setattr(ap, endless, mock.create_autospec(getattr(ap, endless)))
    names = {"my_network": lambda ends: np.zeros((512, 1024))}
    exec(example.replace("count=10", "count=1"), names)
    assert names["found"].map.shape == (512, 1024) and len(names["rows"]) == 1 and capsys.readouterr().out
    ap.open.assert_called_once()
    [serve] = ap.serve.call_args.args
    assert serve(names["maps"].ends, ap.Radar()).shape == (512, 1024)


def test_the_recording_of_the_documents_has_its_two_posts(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    [write] = [block for block in blocks("docs/recordings.md", "python") if "post.npz" in block]
    [text] = [block for block in blocks("docs/recordings.md", "toml") if "Two posts" in block]
    exec(write, {})
    (tmp_path / "post.toml").write_text(text)
    recording = ap.Recording.load("post.toml")
    found = ap.method("iaa").reconstruct(recording.ends, recording.radar, floor=recording.floor)
    assert np.allclose(found.detections[:2, :2], [(0.0, 4.0), (0.275, 7.28)], atol=0.005)
