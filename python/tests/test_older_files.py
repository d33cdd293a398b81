"""Files that the program wrote at version 0.1.0 are read. They stand in tests/data/program-0.1.0 and must never be rewritten."""

from pathlib import Path

import numpy as np
import pytest

import apertura as ap
from apertura import data

FILES = Path(__file__).parents[2] / "tests" / "data" / "program-0.1.0"


def test_rows_of_format_1_are_read():
    rows = ap.read_rows(FILES / "rows.csv")
    assert [(row["set"], row["method"]) for row in rows] == [(s, m) for s in ("1", "bodies", "noise") for m in ("baseline", "live")]
    assert {row["version"] for row in rows} == {1} and {row["program"] for row in rows} == {"0.1.0"}
    assert rows[1]["squared_error"] == 191.90011058700802 and rows[1]["weights"] == "cdda48614d9f"
    assert rows[2]["echoes"] == "1 1 3 0 1 0" and rows[0]["echoes"] is None and rows[4]["detection"] is None
    assert ap.paired(rows, "baseline", "live").scenes == 3


def test_rows_of_format_1_are_written_as_they_were(tmp_path):
    rows = ap.read_rows(FILES / "rows-cfar.csv") + ap.read_rows(FILES / "rows-folder.csv")
    ap.write_rows(tmp_path / "rows.csv", rows)
    assert ap.read_rows(tmp_path / "rows.csv") == rows
    assert rows[0]["cfar_false_alarm"] == 0.005224453035258379 and rows[1]["carrier"] is None


def test_a_dataset_of_version_1_is_read():
    files = data.Files(FILES / "dataset", check=True)
    assert len(files) == 1 and files.manifest["floor"] == "thesis"
    assert files[0]["ends"].shape == (2, 12, 512) and np.sum(np.abs(files[0]["ends"]) ** 2) == pytest.approx(12288)
    assert files[0]["gain"] == pytest.approx(-0.97390835)


def test_scenes_and_recordings_are_read():
    scene = ap.Scene.load(FILES / "scene-bodies.toml")
    assert [type(thing) for thing in scene.objects] == [ap.Wall, ap.Box, ap.Post, ap.Polygon]
    assert scene.radar.elements == 64 and scene.objects[0].roughness_millimetres == 0.3
    assert ap.Recording.load(FILES / "recording.toml").radar.samples == 32
