"""Whether one method is better than another, and how sure a method is."""

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


def test_rows_say_the_doubt_of_a_method(tmp_path):
    live, baseline = ap.evaluate(["live", "baseline"], ["1"], count=1, path=tmp_path / "rows.csv")
    found = ap.method("live").reconstruct(ap.Scene.random("1").simulate().ends)
    expected = float((found.doubt.astype(float) ** 2).sum())
    assert baseline["doubt"] is None and math.isclose(live["doubt"], expected, rel_tol=1e-9)
    target = ap.Scene.random("1").simulate().target
    within = float((abs(found.map - target) <= found.doubt).mean())
    assert baseline["within_doubt"] is None and math.isclose(live["within_doubt"], within, abs_tol=1e-5)
    assert [row["doubt"] for row in ap.read_rows(tmp_path / "rows.csv")] == [live["doubt"], None]
