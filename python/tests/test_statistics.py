"""Whether one method is better than another, and what bad rows share."""

import math

import pytest

import apertura as ap


def test_two_methods_are_compared_scene_by_scene():
    rows = ap.evaluate(["baseline", "live"], ["1"], count=4)
    paired = ap.paired(rows, "baseline", "live")
    of = {name: [row["squared_error"] for row in rows if row["method"] == name] for name in ("baseline", "live")}
    differences = [a - b for a, b in zip(of["baseline"], of["live"], strict=True)]
    assert paired.scenes == 4 and math.isclose(paired.difference, sum(differences) / 4)
    low, high = paired.interval
    assert min(differences) <= low <= paired.difference <= high <= max(differences)
    with pytest.raises(ValueError, match='both "baseline" and "omp"'):
        ap.paired(rows, "baseline", "omp")


def test_what_is_made_bad_by_a_column_is_found():
    row = ap.evaluate(["baseline"], ["2"], count=1)[0]
    rows = [{**row, "index": i, "min_range_metres": i % 7 + 1.0, "missed": int(i % 7 < 2)} for i in range(140)]
    found = ap.rules(rows, bad="missed > 0")
    assert found[0].text == "min_range_metres < 3" and (found[0].bad, found[0].rows, found[0].other_bad) == (20, 20, 0)
    assert ap.rules(rows, bad="missed > 5") == []
    with pytest.raises(ValueError, match="bad: "):
        ap.rules(rows, bad="missed >")


def test_rows_say_the_doubt_of_a_method(tmp_path):
    live, baseline = ap.evaluate(["live", "baseline"], ["1"], count=1, path=tmp_path / "rows.csv")
    found = ap.method("live").reconstruct(ap.Scene.random("1").simulate().ends)
    expected = float((found.doubt.astype(float) ** 2).sum())
    assert baseline["doubt"] is None and math.isclose(live["doubt"], expected, rel_tol=1e-9)
    target = ap.Scene.random("1").simulate().target
    within = float((abs(found.map - target) <= found.doubt).mean())
    assert baseline["within_doubt"] is None and math.isclose(live["within_doubt"], within, abs_tol=1e-5)
    assert [row["doubt"] for row in ap.read_rows(tmp_path / "rows.csv")] == [live["doubt"], None]
