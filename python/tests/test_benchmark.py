"""The benchmark: frozen scenes, entries that can't be changed, scored again."""

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

import apertura as ap
from apertura import _entries, _suites, benchmark

#: Entries of the package's own methods.
ENTRIES = sorted((Path(__file__).parents[2] / "docs" / "benchmark").glob("*.json"))
DOCS = Path(__file__).parents[2] / "docs" / "benchmark.md"
NAMED = {suite.name: suite for suite in benchmark.SUITES}
SUITES = tuple(NAMED[name] for name in ("set 1", "set 2, imperfect elements", "street, physical radar", "noise alone"))
needs_entries = pytest.mark.skipif(not ENTRIES, reason="the entries are in the repository alone")


@pytest.fixture(scope="module")
def one_radar():
    """The live network with the weights for table 3.1 alone: it refuses the physical radar."""
    return ap.method("live", weights=Path(__file__).parents[2] / "assets" / "weights" / "live.safetensors", called="one-radar")


@pytest.fixture(scope="module")
def entry(one_radar):
    """A part of the benchmark by a method that refuses a suite."""
    return benchmark.entry(one_radar, scenes=2, suites=SUITES)


@pytest.fixture
def small(entry, monkeypatch, tmp_path):
    """A file of an entry that is whole in a benchmark of two scenes a suite."""
    for module in (benchmark, _entries):
        monkeypatch.setattr(module, "SCENES", 2)
        monkeypatch.setattr(module, "SUITES", SUITES)
    path = tmp_path / "entry.json"

    def write(change=lambda found: None):
        found = json.loads(json.dumps(entry)) | {"is_whole": True}
        found["sha256"] = benchmark.digest_of(found)
        change(found)
        path.write_text(benchmark.text_of(found))
        return path

    return write


def row(suite="set 1", **figures):
    values = {name: None for name in benchmark.FIGURES} | figures
    return {"suite": suite, "scenes": len(values["squared_error"]), **values}


def differences(told, found):
    return benchmark.differences({"first": told}, {"first": found})


def test_the_scenes_are_the_frozen_ones():
    assert benchmark.check_scenes() == []
    kept = _suites.frozen()
    assert [*kept["suites"]] == [*NAMED]
    assert (kept["apertura_benchmark"], kept["seed"], kept["scenes"]) == (benchmark.VERSION, benchmark.SEED, benchmark.SCENES)


def test_other_scenes_and_conditions_are_noticed(monkeypatch):
    suite = NAMED["set 2 at 20 dB"]
    other = benchmark.Suite(suite.name, suite.set, "snr=21")
    assert benchmark.check_scenes([suite]) == [] and benchmark.check_scenes([other]) == [suite.name]
    monkeypatch.setattr(_suites, "SEED", 7)
    assert benchmark.check_scenes(SUITES) == [suite.name for suite in SUITES]


def test_portable_samples_are_the_frozen_ones():
    code = f"""
from apertura import benchmark
for suite in benchmark.SUITES:
    if suite.name in {[suite.name for suite in SUITES]}:
        print(suite.name, benchmark.samples_hash(suite, benchmark.SEED, benchmark.SCENES), sep=": ")
"""
    found = subprocess.run([sys.executable, "-c", code], env={**os.environ, "APERTURA_SIMD": "portable"}, capture_output=True, text=True, check=True)
    kept = _suites.frozen()["suites"]
    assert dict(line.split(": ") for line in found.stdout.splitlines()) == {suite.name: kept[suite.name]["samples_sha256"] for suite in SUITES}


def test_the_score_is_that_of_an_evaluation():
    found = benchmark.score(ap.method("bartlett"), NAMED["set 3"], 11, 3)
    rows = ap.evaluate(["bartlett"], ["3"], count=3, seed=11)
    for name, column in (("squared_error", "squared_error"), ("detection", "detection"), ("detection_at_rate", "detection_at_printed")):
        assert found[name] == pytest.approx([row[column] for row in rows], rel=1e-6)


def test_the_ideal_target_has_neither_errors_nor_noise():
    suite = NAMED["set 2, imperfect elements"]
    [scene] = suite.scenes(5, 1)
    ideal = benchmark.target_ideal(scene, suite.normalisation)
    heard = ap.Scene.random("2", 5, 0).simulate(floor="exact", normalisation=suite.normalisation).target
    assert (ideal == heard).all()
    assert (ideal != scene.simulate(floor=suite.floor, normalisation=suite.normalisation).target).mean() > 0.05


def test_nothing_is_detected_in_noise_alone():
    noise = benchmark.score(ap.method("baseline"), NAMED["noise alone"], 3, 2)
    assert noise["detection"] is None and noise["detection_at_rate"] is None and noise["false_alarm"] == [0, 0]


def test_a_refused_suite_stands_with_its_reason(entry, one_radar):
    [refused] = [row for row in entry["first"]["suites"] if "refused" in row]
    assert refused["suite"] == "street, physical radar" and refused["refused"].startswith("one-radar: ")
    with pytest.raises(ValueError) as told:
        one_radar.reconstruct(next(NAMED[refused["suite"]].scenes(1, 1)).simulate(floor="thermal").ends, NAMED[refused["suite"]].radar)
    assert str(told.value) == refused["refused"]
    assert refused["refused"] in benchmark.table(entry)
    scored = row(refused["suite"], squared_error=[1.0], false_alarm=[0.0])
    [told] = differences([refused], [scored])
    assert "refused in the entry alone" in told
    assert differences([refused], [refused]) == []


def test_an_entry_is_read_as_it_was_written(small):
    found = benchmark.read_entry(small())
    assert found["is_whole"] and [len(row["squared_error"]) for row in found["first"]["suites"] if "squared_error" in row] == [2, 2, 2]
    assert sum("squared_error" in line for line in small().read_text().splitlines()) == 6, "one line a list"


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda found: found["first"]["suites"][0].update(squared_error=[1.0, 2.0]), "the seed of its second draw does not follow"),
        (lambda found: found["second"]["suites"][0].update(squared_error=[1.0, 2.0]), "its SHA-256 is another one"),
        (lambda found: found["method"].update(told="nothing"), "its SHA-256 is another one"),
        (lambda found: found["second"].update(seed=5), "the seed of its second draw does not follow"),
        (lambda found: found["first"].update(seed=5), "the first draw is of seed 5"),
        (lambda found: found.update(is_whole=False), "is_whole is not true"),
        (lambda found: found["second"]["suites"].pop(0), "the second draw has not the suites of version 2: no set 1"),
        (lambda found: found["first"]["suites"][0].update(suite="set 9"), "no set 1, an unknown set 9"),
        (lambda found: found["first"]["suites"].reverse(), "another order"),
        (lambda found: found["first"]["suites"][0].update(scenes=1), "the first draw has not 2 scenes of set 1"),
        (lambda found: found["first"]["suites"][0]["squared_error"].pop(), "the first draw has not 2 scenes of set 1"),
        (lambda found: found["first"]["suites"][0].update(squared_error=None), "no entry"),
        (lambda found: found.update(apertura_benchmark=1), "version 1 of the benchmark; this package has version 2"),
        (lambda found: found.pop("second"), "no entry"),
    ],
)
def test_a_changed_entry_is_refused_with_the_reason(small, change, words):
    with pytest.raises(ValueError, match=words):
        benchmark.read_entry(small(change))


def test_a_part_is_no_entry(entry, tmp_path):
    path = tmp_path / "entry.json"
    for text, words in ((benchmark.text_of(entry), "no set 2, no set 3"), ("[", "no entry"), ("[]", "no entry")):
        path.write_text(text)
        with pytest.raises(ValueError, match=words):
            benchmark.read_entry(path)


def test_only_another_score_has_another_second_draw(entry):
    rows = entry["first"]["suites"]
    assert entry["second"]["seed"] == benchmark.second_seed(rows)
    nudged, better = (json.loads(json.dumps(rows)) for _ in range(2))
    nudged[0]["squared_error"] = [value * (1 + 1e-9) for value in nudged[0]["squared_error"]]
    better[0]["squared_error"] = [value / 2 for value in better[0]["squared_error"]]
    assert benchmark.second_seed(nudged) == benchmark.second_seed(rows) != benchmark.second_seed(better)


def test_figures_may_differ_by_paired_errors():
    names = ("squared_error", "detection", "false_alarm")
    told = row(squared_error=[100.0, 120.0, 90.0, 130.0], detection=[1.0, 0.6, 0.6, 1.0], false_alarm=[1e-5, 2e-5, 1.5e-5, 2e-5])
    times = lambda factor: row(**{name: [value * factor for value in told[name]] for name in names})
    assert differences([told], [told]) == differences([told], [times(1.0001)]) == []
    one = row(**{**told, "squared_error": [100.0, 900.0, 90.0, 130.0]})
    assert differences([told], [one]) == [], "one scene that goes another way is no other method"
    found = [difference.split(": ")[1].split(" is ")[0] for difference in differences([told], [times(1.2)])]
    assert found == [*names], "false alarms are few: the tolerance is relative"
    assert differences([told], [row(**{name: told[name][:3] for name in names})]) == []


def test_chance_alone_passes_the_whole_check(monkeypatch):
    # Student's t at 0.0455, and at 0.05 and 0.001 as printed in tables.
    for scenes, level, expected in ((20, 0.05, 2.093), (20, 0.001, 3.883), (3, 0.05, 4.303), (2, 0.05, 12.706), (10_001, 0.0455, 2.0002)):
        monkeypatch.setattr(_entries, "BEYOND_TWO_ERRORS", 10 * level)
        assert _entries.errors_allowed(scenes, 10) == pytest.approx(expected, abs=6e-4)
    monkeypatch.undo()
    spread = random.Random(2)
    noise = lambda mean: [row(name, squared_error=[spread.gauss(mean, 9.0) for _ in range(20)], false_alarm=[0.0] * 20) for name in NAMED]
    refused = sum(differences(noise(100.0), noise(100.0)) != [] for _ in range(400))
    assert refused < 400 * 0.09, "one in twenty"
    assert len(differences(noise(100.0), noise(130.0))) == len(NAMED)


def test_figures_that_are_better_everywhere_are_noticed():
    found = [row(name, squared_error=[100.0 + index for index in range(20)], false_alarm=[0.0] * 20) for name in NAMED]
    told = json.loads(json.dumps(found))
    for each in told:
        each["squared_error"][3] /= 2
    assert differences(told, found) == [], "one scene of a suite is within its tolerance"
    assert benchmark.changed_scenes(told, found) == len(NAMED)
    assert benchmark.paired_z(told, found) > benchmark.LIMIT > abs(benchmark.paired_z(found, found))


def test_one_z_pools_the_suites():
    spread = random.Random(1)
    draw = lambda mean: [row(name, squared_error=[spread.gauss(mean, 40.0) for _ in range(20)], false_alarm=[0.0] * 20) for name in NAMED]
    honest, tuned, later = draw(200.0), draw(185.0), draw(200.0)
    assert abs(benchmark.pooled_z(later, honest, draw(200.0))) < benchmark.LIMIT < benchmark.pooled_z(later, tuned)
    # By hand: 12 against 10, with errors of 1 and 1 on one suite.
    one, other = row(squared_error=[9.0, 11.0], false_alarm=[0.0, 0.0]), row(squared_error=[11.0, 13.0], false_alarm=[0.0, 0.0])
    assert benchmark.pooled_z([other], [one]) == pytest.approx(2**0.5)
    refused = {"suite": "set 1", "scenes": 2, "refused": "no"}
    assert benchmark.pooled_z([other, refused], [one, refused]) == pytest.approx(2**0.5)


def test_a_check_draws_scenes_of_its_own(small, one_radar, monkeypatch):
    monkeypatch.setattr(benchmark, "LIMIT", 99.0)
    told = benchmark.check(small(), one_radar, "", scenes=2, seed=77)
    assert "the figures are those of the entry" in told and "seed 77" in told
    drawn = [benchmark.check(small(), one_radar, "", scenes=2).split("seed ")[1] for _ in range(2)]
    assert drawn[0] != drawn[1]
    monkeypatch.setattr(benchmark, "pooled_z", lambda *draws: 2.4)
    monkeypatch.setattr(benchmark, "LIMIT", 2.33)
    with pytest.raises(ValueError, match="was tuned on the scenes of its draws"):
        benchmark.check(small(), one_radar, "", scenes=2, seed=77)


def test_a_check_is_of_the_same_method(small, one_radar):
    for name, method, weights in (("name", ap.method("baseline"), ""), ("weights", one_radar, "0f")):
        with pytest.raises(ValueError, match=f"whose {name} is"):
            benchmark.check(small(), method, weights, scenes=2)


@needs_entries
@pytest.mark.parametrize("path", ENTRIES, ids=lambda path: path.stem)
def test_the_entries_are_those_of_this_package(path):
    found = benchmark.read_entry(path)
    method = ap.method(path.stem)
    assert found["method"]["name"] == method.name and found["method"]["eta"] == pytest.approx(method.eta, abs=1e-6)
    assert found["method"]["weights"] == method.weights
    entered, again = found["first"]["suites"], benchmark.draw(method, benchmark.SEED, 3)["suites"]
    assert differences(entered, again) == []


@needs_entries
def test_the_table_of_entries_is_the_printed_one():
    command = "python -m apertura.benchmark --table docs/benchmark/*.json"
    [_, after] = DOCS.read_text().split(f"<!-- table: {command} -->\n")
    table = after.removeprefix(after[: after.index("| |")]).split("\n<!-- /table -->")[0]
    assert table == benchmark.markdown([benchmark.read_entry(path) for path in ENTRIES])
    assert {path.stem for path in ENTRIES} <= {*benchmark.OWN}


def test_the_command_tells_what_is_wrong(tmp_path):
    (tmp_path / "entry.json").write_text("{}")
    for arguments, words in (
        (["--method", "magic"], 'unknown method "magic"'),
        (["--method", "baseline", "--scenes", "0"], "--scenes is 0"),
        (["--method", "baseline", "--check", "entry.json", "--scenes", "2"], "--scenes is 2; expected 3 to 20"),
        (["--method", "baseline", "--check", "entry.json"], "no entry"),
        (["--table", "nowhere.json"], "nowhere.json"),
        (["--all"], "expected -o FOLDER"),
        (["--method-command", "/nowhere/program"], "can't be started"),
    ):
        found = subprocess.run([sys.executable, "-m", "apertura.benchmark", *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert found.returncode != 0 and words in found.stderr, found.stderr
