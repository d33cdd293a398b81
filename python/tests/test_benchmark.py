"""The benchmark: frozen scenes, entries that can't be changed, scored again."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import apertura as ap
from apertura import benchmark

#: Entries of the package's own methods.
ENTRIES = sorted((Path(__file__).parents[2] / "docs" / "benchmark").glob("*.json"))
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


@pytest.mark.skipif(not ENTRIES, reason="the entries are in the repository alone")
@pytest.mark.parametrize("path", ENTRIES, ids=lambda path: path.stem)
def test_the_entries_are_those_of_this_package(path):
    found = benchmark.read_entry(path)
    method = ap.method(path.stem)
    assert found["is_whole"] and found["method"]["name"] == method.name and found["method"]["eta"] == pytest.approx(method.eta, abs=1e-6)
    assert found["method"]["weights"] == benchmark.weights_of(method.name)
    [suite] = [suite for suite in benchmark.SUITES if suite.name == "set 1"]
    [entered] = [row for row in found["first"]["suites"] if row["suite"] == suite.name]
    again = benchmark.score(method, suite, benchmark.SEED, benchmark.SCENES)
    halves = lambda row: {half: {"suites": [row]} for half in ("first", "second")}
    assert benchmark.differences(halves(entered), halves(again)) == []
    # A method that was tuned on the first draw is worse on the second.
    means = lambda half: [row["squared_error"] for row in found[half]["suites"]]
    worse = [b["mean"] - a["mean"] > 4 * (a["standard_error"] + b["standard_error"]) for a, b in zip(means("first"), means("second"), strict=True)]
    assert not any(worse)


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
