"""Methods of any kind on scenes of any kind."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import apertura as ap

WEIGHTS = Path(__file__).parents[2] / "assets" / "weights" / "live.safetensors"
CHIP = ap.Radar(elements=86, end_elements=8, samples=128)


def without_times(rows):
    return [{name: value for name, value in row.items() if name != "milliseconds"} for row in rows]


def zero(ends, radar):
    return np.zeros((radar.samples, radar.elements))


def wrong(ends, radar):
    raise KeyError("no such weight")


def asks_the_package(ends, radar, request):
    """A function that computes by the package, as one with a network does."""
    found = ap.method("matched-filter").reconstruct(ends, radar, normalisation=request.normalisation)
    return found.map, 0.7


def test_a_function_stands_beside_names_and_methods():
    own = ap.Method.of_function(zero, name="nothing", eta=0.5, weights="0f3a")
    rows = ap.evaluate(["baseline", ap.method("capon"), zero, own], ["2"], count=1, radar=CHIP)
    assert [row["method"] for row in rows] == ["baseline", "capon", "zero", "nothing"]
    assert [row["weights"] for row in rows] == ["", "", "", "0f3a"] and own.weights == "0f3a"
    assert rows[2]["detection"] == 0 and rows[2]["radar"] == "elements=86 end_elements=8 samples=128"


def test_a_function_is_measured_beside_live():
    rows = ap.evaluate([asks_the_package, "live"], ["1"], count=2)
    assert [(row["method"], row["index"]) for row in rows] == [("asks_the_package", 0), ("live", 0), ("asks_the_package", 1), ("live", 1)]
    expected = ap.evaluate(["matched-filter"], ["1"], count=2)
    assert [row["squared_error"] for row in rows if row["method"] != "live"] == [row["squared_error"] for row in expected]
    assert [row["eta"] for row in rows if row["method"] != "live"] == [pytest.approx(0.7)] * 2


def test_a_function_may_ask_the_package_on_a_single_thread():
    before = ap.threads()
    ap.set_threads(1)
    try:
        assert len(ap.evaluate([asks_the_package], ["1"], count=1, radar=CHIP)) == 1
    finally:
        ap.set_threads(before)


def test_what_a_function_raises_is_the_cause():
    with pytest.raises(ValueError, match="wrong on scene 0 of set 1.*no such weight") as told:
        ap.evaluate([wrong], ["1"], count=1, radar=CHIP)
    assert isinstance(told.value.__cause__, KeyError)
    method = ap.Method.of_function(wrong)
    with pytest.raises(ValueError, match="no such weight") as told:
        method.reconstruct(ap.Scene.random("1", radar=CHIP).simulate().ends, CHIP)
    assert isinstance(told.value.__cause__, KeyError)


@pytest.mark.parametrize(
    "answer, words",
    [
        (lambda ends, radar: np.zeros((3, 3)), "its map has shape [3, 3]; expected [128, 86]"),
        (lambda ends, radar: np.full((128, 86), np.nan), "NaN"),
        (lambda ends, radar: np.full((128, 86), -7.0), "expected Lambda, 0 to 1"),
        (lambda ends, radar: (np.zeros((128, 86)), 7.0), "its threshold is 7"),
        (lambda ends, radar: None, "dtype"),
    ],
)
def test_answers_that_are_no_map_are_told(answer, words):
    with pytest.raises(ValueError) as told:
        ap.evaluate([ap.Method.of_function(answer, name="own")], ["1"], count=1, radar=CHIP)
    assert words in str(told.value)


def test_names_of_functions_are_told():
    with pytest.raises(ValueError, match='name is "<lambda>"; expected 1 to 40'):
        ap.Method.of_function(lambda ends, radar: None)
    with pytest.raises(ValueError, match='name is "live", as a method of this package'):
        ap.Method.of_function(zero, name="live")


def test_other_weights_have_a_name_of_their_own(tmp_path):
    own = tmp_path / "mine.safetensors"
    own.write_bytes(WEIGHTS.read_bytes())
    method = ap.method("live", weights=own)
    assert method.name == "live-mine" and method.weights == ap.method("live").weights
    assert ap.method("live", weights=own, called="second").name == "second"
    rows = ap.evaluate(["live", own], ["1"], count=1)
    assert [row["method"] for row in rows] == ["live", "live-mine"] and rows[0]["squared_error"] == rows[1]["squared_error"]
    assert pickle.loads(pickle.dumps(method)).name == "live-mine"
    own.write_bytes(b"no weights at all")
    with pytest.raises(ValueError, match="mine.safetensors"):
        ap.method("live", weights=own)
    with pytest.raises(FileNotFoundError, match="none.safetensors"):
        ap.method("live", weights="none.safetensors")


def test_scenes_of_one_s_own_are_a_set():
    scenes = [ap.Scene([ap.Point(x, 4.0)], radar=CHIP, noise_seed=7) for x in (-1.0, 0.0, 2.0)]
    rows = ap.evaluate(["baseline"], scenes)
    assert [(row["set"], row["index"], row["carrier"]) for row in rows] == [("scenes", i, None) for i in range(3)]
    maps = scenes[2].simulate()
    found = ap.method("baseline").reconstruct(maps.ends, CHIP)
    assert rows[2]["squared_error"] == ap.metrics(maps.target, found.map, found.eta).squared_error
    both = ap.evaluate(["baseline"], ["1", scenes[0]], count=2)
    assert [row["set"] for row in both] == ["1", "1", "scenes"]
    other = ap.evaluate(["baseline"], scenes[:1], radar=CHIP.replace(window="blackman"))
    assert other[0]["squared_error"] != rows[0]["squared_error"] and rows[0]["scenes"] != other[0]["scenes"]


def test_elements_and_target_are_columns_of_rows():
    usual, drawn, ideal = (
        ap.evaluate(["baseline"], ["2"], count=1, radar=CHIP, floor="snr=30", **given)[0]
        for given in ({}, {"elements": (0.5, 5.0, 0.0)}, {"elements": (0.5, 5.0, 0.0), "target": "ideal", "normalisation": "db=60"})
    )
    assert (usual["elements"], usual["target"]) == ("", "measured")
    assert (drawn["elements"], ideal["target"]) == ("drawn 0.5 dB 5 degrees 0 mm", "ideal")
    scene = ap.Scene.random("2", radar=CHIP).replace(elements=ap.Elements.built(gain_db=0.5, phase_degrees=5.0, radar=CHIP))
    maps = scene.simulate(floor="snr=30", normalisation="db=60")
    found = ap.method("baseline").reconstruct(maps.ends, CHIP, floor="snr=30", normalisation="db=60")
    target = scene.replace(elements=None).simulate(floor="exact", normalisation="db=60").target
    assert ideal["squared_error"] == ap.metrics(target, found.map, found.eta).squared_error
    built = ap.evaluate(["baseline"], ["2"], count=1, radar=CHIP, elements=scene.elements)[0]
    assert built["elements"].startswith("built ")


def lengths(heard, radar):
    return np.full((radar.samples, radar.elements), len(heard) / 100)


def test_a_layout_is_heard_by_functions_and_the_matched_filter():
    nested = ap.layout("nested=8x8", CHIP)
    assert nested[:8] == [*range(8)] and nested[8:] == [8, 17, 26, 35, 44, 53, 62, 71]
    rows = ap.evaluate(["matched-filter", lengths], ["2"], count=1, radar=CHIP, layout=nested)
    assert {row["layout"] for row in rows} == {"0-8 17 26 35 44 53 62 71"}
    target = ap.Scene.random("2", radar=CHIP).simulate().target
    assert rows[1]["squared_error"] == pytest.approx(((target - 0.16) ** 2).sum(), rel=1e-5)
    assert without_times(ap.evaluate(["matched-filter", lengths], ["2"], count=1, radar=CHIP, layout="nested=8x8")) == without_times(rows)
    assert ap.evaluate(["capon"], ["2"], count=1, radar=CHIP, layout="two-ends")[0]["layout"] == ""
    assert ap.method("iaa").refusal(CHIP, layout=nested) is None and "two ends" in ap.method("capon").refusal(CHIP, layout="nested=8x8")
    every = ap.evaluate(["matched-filter"], ["2"], count=1, radar=CHIP, layout=list(range(86)))
    assert every[0]["squared_error"] < rows[0]["squared_error"]
    with pytest.raises(ValueError, match="capon.*it hears the two ends of an array, and no other layout"):
        ap.evaluate(["capon"], ["2"], count=1, radar=CHIP, layout=nested)
    with pytest.raises(ValueError, match="element 86; the radar has elements 0 to 85"):
        ap.evaluate([lengths], ["2"], count=1, radar=CHIP, layout=[0, 86])


@pytest.mark.parametrize("name", ["iaa", "sbl", "omp"])
def test_model_based_methods_hear_a_layout(name):
    nested = ap.layout("nested=8x8", CHIP)
    maps = ap.Scene.random("2", radar=CHIP).simulate()
    of = lambda method: ap.metrics(maps.target, *(lambda found: (found.map, found.eta))(ap.method(method).reconstruct(maps.samples[nested], CHIP, layout=nested)))
    found, filtered = of(name), of("matched-filter")
    assert found.detection > 0.9 and found.squared_error < 0.5 * filtered.squared_error
    rows = ap.evaluate([name], ["2"], count=1, radar=CHIP, layout=nested)
    assert rows[0]["squared_error"] == pytest.approx(found.squared_error, rel=1e-6)


def test_layouts_have_names():
    assert ap.layout("two-ends", CHIP) == [*range(8), *range(78, 86)]
    assert ap.layout("coprime=3x5", CHIP) == sorted({0, 3, 6, 9, 12, 5, 10, 15, 20, 25})
    assert ap.layout("random=24:3", CHIP) == ap.layout("random=24:3", CHIP) and len(ap.layout("random=24", CHIP)) == 24
    assert ap.layout("thinned=40", CHIP) == ap.layout("0 40,80", CHIP) == [0, 40, 80]
    for name, words in (("magic", "expected full, two-ends"), ("nested=4", "expected full"), ("nested=40x40", "has elements 0 to 85"), ("random=87", "1 to 86")):
        with pytest.raises(ValueError, match=words):
            ap.layout(name, CHIP)


def test_a_method_says_why_it_refuses_a_radar():
    assert ap.method("live").refusal() is None and ap.method("capon").refusal(CHIP) is None
    assert "this radar has 86 elements" in ap.method("live").refusal(CHIP)


def test_a_file_of_rows_is_gone_on_with(tmp_path):
    path = tmp_path / "rows.csv"
    # So many that the workers have not done all of them before the callback stops them.
    run = {"count": 30, "radar": CHIP, "path": path}
    found = []

    def stop(row):
        found.append(row)
        if len(found) == 2:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ap.evaluate(["baseline", "bartlett"], ["1"], on_row=stop, **run)
    kept = ap.read_rows(path)
    assert 2 <= len(kept) < 60
    parts = []
    rows = ap.evaluate(["baseline", "bartlett"], ["1"], progress=parts.append, **run)
    assert parts[-1] == 1 and parts[0] > len(kept) / 60
    assert [row for row in rows if row in kept] == sorted(kept, key=lambda row: (row["index"], ["baseline", "bartlett"].index(row["method"])))
    assert without_times(rows) == without_times(ap.evaluate(["baseline", "bartlett"], ["1"], count=30, radar=CHIP))
    before = path.read_bytes()
    assert ap.evaluate(["baseline", "bartlett"], ["1"], **run) == rows and path.read_bytes() == before
    with pytest.raises(ValueError, match="rows of another run: seed is 0 there and 1 here; name another file, or write over this one with overwrite=True"):
        ap.evaluate(["baseline", "bartlett"], ["1"], seed=1, **run)
    (tmp_path / "text.csv").write_text("mine")
    with pytest.raises(ValueError, match="text.csv"):
        ap.evaluate(["baseline"], ["1"], count=1, path=tmp_path / "text.csv")
    assert path.read_bytes() == before and (tmp_path / "text.csv").read_text() == "mine"
    other = ap.evaluate(["baseline"], ["1"], count=1, seed=1, radar=CHIP, path=path, overwrite=True)
    assert ap.read_rows(path) == other
    with pytest.raises(OSError, match="no"):
        ap.evaluate(["baseline"], ["1"], count=1, path=tmp_path / "no" / "rows.csv")
    scenes = [ap.Scene([ap.Point(1.0, 4.0)], radar=CHIP)]
    mixed = [ap.evaluate(["baseline"], ["1", *scenes], count=1, radar=CHIP, path=tmp_path / "mixed.csv") for _ in range(2)]
    assert [row["set"] for row in mixed[0]] == ["1", "scenes"] and mixed[0] == mixed[1]


def test_rows_of_a_function_that_changed_are_refused(tmp_path):
    level = [0.2]

    def flat(ends, radar):
        return np.full((radar.samples, radar.elements), level[0]) + np.eye(radar.samples, radar.elements) / 2

    run = {"count": 2, "radar": CHIP, "path": tmp_path / "rows.csv"}
    rows = ap.evaluate([flat], ["1"], **run)
    assert ap.evaluate([flat], ["1"], **run) == rows
    level[0] = 0.4
    with pytest.raises(ValueError, match="flat has SE .* another function made the file"):
        ap.evaluate([flat], ["1"], **run)
    assert ap.evaluate([flat], ["1"], overwrite=True, **run) != rows


def test_robustness_takes_a_radar_and_functions():
    rows = ap.robustness(["baseline", zero], "2", radar=CHIP, scales=[0, 2], count=2)
    assert [(row["method"], row["scale"], row["phase_degrees"]) for row in rows] == [
        ("baseline", 0.0, 0.0), ("baseline", 2.0, 20.0), ("zero", 0.0, 0.0), ("zero", 2.0, 20.0)
    ]
    assert rows[0]["squared_error"] != rows[1]["squared_error"]
    assert rows[2]["squared_error"] == rows[3]["squared_error"]


def test_a_threshold_takes_functions():
    found = ap.threshold(zero, false_alarm_percent=30.0, sets=["1"], count=4, radar=CHIP)
    assert found.eta < 0.01 and found.false_alarm == 0


def test_a_parquet_table_is_read(tmp_path):
    pytest.importorskip("pyarrow")
    from apertura import _journal, campaign

    rows = ap.evaluate(["baseline"], ["1"], count=2)
    bad = campaign.failed(campaign.Run(("baseline",), ("1",), 3), ("1", 2, "baseline"), "no memory")
    _journal.write_table(tmp_path / "rows.parquet", [*rows, bad])
    assert ap.read_rows(tmp_path / "rows.parquet") == rows
    with pytest.raises(ValueError, match="written as CSV"):
        ap.write_rows(tmp_path / "rows.parquet", rows)
    (tmp_path / "text.parquet").write_text("mine")
    with pytest.raises(ValueError, match="text.parquet"):
        ap.read_rows(tmp_path / "text.parquet")
