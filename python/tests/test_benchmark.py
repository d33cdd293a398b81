"""The benchmark: frozen scenes, entries that can't be changed, scored again."""

import json
import subprocess
import sys

import pytest

import apertura as ap
from apertura import benchmark

SUITES = tuple(suite for suite in benchmark.SUITES if suite.name in ("set 1", "set 2, imperfect elements", "noise alone"))


@pytest.fixture(scope="module")
def entry():
    return benchmark.entry(ap.method("baseline"), scenes=2, suites=SUITES)


def test_the_scenes_are_the_frozen_ones():
    assert benchmark.check_scenes() == []
    assert [*benchmark.frozen()["suites"]] == [suite.name for suite in benchmark.SUITES]


def test_other_scenes_are_noticed(monkeypatch):
    monkeypatch.setattr(benchmark, "SEED", 7)
    assert benchmark.check_scenes(SUITES) == [suite.name for suite in SUITES]


def test_the_score_is_that_of_an_evaluation():
    suite = next(suite for suite in benchmark.SUITES if suite.name == "set 3")
    found = benchmark.score(ap.method("bartlett"), suite, 11, 3)
    rows = ap.evaluate(["bartlett"], ["3"], count=3, seed=11)
    mean = lambda name: sum(row[name] for row in rows) / 3
    assert found["squared_error"]["mean"] == pytest.approx(mean("squared_error"))
    assert found["detection"]["mean"] == pytest.approx(mean("detection"))
    assert found["detection_at"]["mean"] == pytest.approx(mean("detection_at_printed"))


def test_nothing_is_detected_in_noise_alone(entry):
    [noise] = [row for row in entry["first"]["suites"] if row["suite"] == "noise alone"]
    assert noise["detection"] is None and noise["detection_at"] is None and noise["false_alarm"]["mean"] == 0


def test_a_changed_entry_is_noticed(entry, tmp_path):
    path = tmp_path / "entry.json"
    path.write_text(json.dumps(entry))
    assert benchmark.read_entry(path) == entry
    better = json.loads(json.dumps(entry))
    better["first"]["suites"][0]["squared_error"]["mean"] /= 2
    path.write_text(json.dumps(better))
    with pytest.raises(ValueError, match="was changed"):
        benchmark.read_entry(path)
    for text, words in (("{}", "no entry"), ("[", "no entry"), (json.dumps({**entry, "apertura_benchmark": 9}), "version 9")):
        path.write_text(text)
        with pytest.raises(ValueError, match=words):
            benchmark.read_entry(path)


def test_the_second_seed_depends_on_the_weights(entry):
    rows = entry["first"]["suites"]
    seeds = {benchmark.second_seed({**entry["method"], "weights": weights}, rows) for weights in ("", "0f", "1f")}
    assert len(seeds) == 3 and entry["second"]["seed"] in seeds


def test_worse_figures_are_told(entry):
    worse = json.loads(json.dumps(entry))
    worse["second"]["suites"][0]["squared_error"]["mean"] *= 1.01
    assert benchmark.differences(entry, entry) == []
    [told] = benchmark.differences(entry, worse)
    assert "second draw, set 1: squared_error" in told


def test_the_command_tells_what_is_wrong(tmp_path):
    (tmp_path / "entry.json").write_text("{}")
    for arguments, words in (
        (["--method", "magic"], 'unknown method "magic"'),
        (["--method", "baseline", "--scenes", "0"], "--scenes is 0"),
        (["--method", "baseline", "--check", "entry.json"], "no entry"),
        (["--method-command", "/nowhere/program"], "can't be started"),
    ):
        found = subprocess.run([sys.executable, "-m", "apertura.benchmark", *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert found.returncode != 0 and words in found.stderr, found.stderr
