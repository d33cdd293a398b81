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


def test_the_half_hour_of_research_runs(monkeypatch, tmp_path, capsys):
    pytest.importorskip("torch")
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "target").mkdir()  # the page's command for a dataset made it
    page = blocks("docs/data.md", "python")
    research = [block for block in page if "ap.data.Files" not in block]
    assert len(research) == len(page) - 1 == 6
    names = {}
    for block in research:
        for long, short in (("length=400", "length=12"), ("range(10)", "range(2)"), ("count=8", "count=1"), ("count=3", "count=1")):
            block = block.replace(long, short)
        exec(block, names)
    out = capsys.readouterr().out
    assert "mine" in out and "hybrid" in out and "matched-filter" in out and "this radar has 128 elements" in out
    assert (tmp_path / "target" / "mine.png").stat().st_size > 10_000
    assert {row["layout"] for row in ap.read_rows("target/nested.csv")} == {"0-12 25 38 51 64 77 90 103 116"}
    assert ap.Radar.load("target/radar.toml") == names["radar"] and len(ap.data.Files("target/nested")) == 2
