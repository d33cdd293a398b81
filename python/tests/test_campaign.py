"""Campaigns on Dask: workers and programs that are killed, rows that are errors."""

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import apertura as ap
from apertura import _journal, campaign

METHODS, SETS = ("baseline", "bartlett"), ("1", "clusters")


def figures(rows):
    return [{name: value for name, value in row.items() if name != "milliseconds"} for row in rows]


def expected(count, **options):
    return figures(ap.evaluate(METHODS, SETS, count=count, **options))


def test_rows_of_some_scenes_are_those_of_the_whole_run():
    whole = expected(4, seed=3)
    only = [("clusters", 2, "bartlett"), ("1", 3, "baseline")]
    some = figures(ap.evaluate(METHODS, SETS, count=4, seed=3, only=only))
    assert some == [row for row in whole if (row["set"], row["index"], row["method"]) in only]
    for row in ((("1", 4, "baseline")), ("2", 0, "baseline"), ("1", 0, "capon")):
        with pytest.raises(ValueError, match="is no row of this run"):
            ap.evaluate(METHODS, SETS, count=4, only=[row])


def test_written_rows_are_read_again(tmp_path):
    path = tmp_path / "rows.csv"
    rows = ap.evaluate(METHODS, ["1", "noise"], count=2, path=path, floor="dbm=-20")
    assert ap.read_rows(path) == rows
    ap.write_rows(tmp_path / "again.csv", rows)
    assert (tmp_path / "again.csv").read_bytes() == path.read_bytes()
    with pytest.raises(ValueError, match="line 2, column index"):
        ap.write_rows(tmp_path / "bad.csv", [{**rows[0], "index": "first"}])
    assert not (tmp_path / "bad.csv").exists()
    with pytest.raises(OSError):
        ap.write_rows(tmp_path / "no" / "rows.csv", rows)


def test_a_worker_that_is_killed_loses_no_row(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(campaign, "SCENES_A_TASK", 1)
    added, killed, clients = [], [], []
    add, client_of = _journal.Journal.add, campaign.client_of

    def kept_client(*given):
        clients.append(client_of(*given))
        return clients[-1]

    def add_and_kill(self, rows):
        add(self, rows)
        added.extend(rows)
        if not killed:
            killed.append(sorted(clients[0].run(os.getpid).values())[0])
            os.kill(killed[0], signal.SIGKILL)

    monkeypatch.setattr(campaign, "client_of", kept_client)
    monkeypatch.setattr(_journal.Journal, "add", add_and_kill)
    rows = campaign.campaign(campaign.Run(METHODS, SETS, 6), tmp_path / "rows.csv", workers=2)
    assert killed and figures(rows) == expected(6)
    keys = [_journal.key_of(row) for row in added]
    assert len(keys) == len({*keys}) == 6 * 2 * 2
    assert figures(ap.read_rows(tmp_path / "rows.csv")) == expected(6)
    assert not (tmp_path / "rows.csv.journal").exists()


def test_parquet_has_the_rows_with_their_errors(tmp_path):
    pytest.importorskip("pyarrow")
    rows = ap.evaluate(METHODS, ["1"], count=2)
    bad = campaign.failed(campaign.Run(METHODS, ("1",), 3), ("1", 2, "baseline"), "no memory")
    _journal.write_table(tmp_path / "rows.parquet", [*rows, bad])
    found = _journal.read_table(tmp_path / "rows.parquet")
    assert [row.pop("error") for row in found] == [None] * 4 + ["no memory"]
    assert found[:4] == rows and found[4]["index"] == 2 and found[4]["squared_error"] is None


#: A scene a task, so that there is a middle.
SMALL_TASKS = ("-c", "from apertura import campaign; campaign.SCENES_A_TASK = 1; campaign.main()")


def start(folder, *arguments, program=("-m", "apertura.campaign")):
    command = [sys.executable, *program, "--out", "rows.csv", "--workers", "2", "--progress", "1", *arguments]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True)


def test_a_campaign_that_is_killed_goes_on(tmp_path):
    pytest.importorskip("distributed")
    arguments = ["--methods", ",".join(METHODS), "--sets", ",".join(SETS), "--count", "12"]
    first = start(tmp_path, *arguments, program=SMALL_TASKS)
    journal = tmp_path / "rows.csv.journal"
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline and not (journal.exists() and journal.read_bytes().count(b"\n") > 3):
        time.sleep(0.02)
    os.killpg(first.pid, signal.SIGKILL)
    first.communicate()
    assert not (tmp_path / "rows.csv").exists()
    # It may have been stopped within a line.
    journal.write_bytes(journal.read_bytes() + b'{"set": "1", "ind')
    second = start(tmp_path, *arguments)
    out, errors = second.communicate(timeout=240)
    assert second.returncode == 0, errors
    assert "going on with the rest" in errors and "wrote rows.csv: 48 rows" in out
    assert figures(ap.read_rows(tmp_path / "rows.csv")) == expected(12)


def test_a_campaign_hears_a_layout():
    radar = ap.Radar(elements=86, end_elements=8, samples=128)
    run = campaign.Run(("matched-filter",), ("2",), 1, radar=radar, layout=(0, 1, 9, 85))
    [row] = campaign.rows_of(run, [*run.keys()])
    assert row["layout"] == "0-1 9 85" and run.told()["layout"] == [0, 1, 9, 85]
    assert "layout" not in campaign.Run(METHODS, SETS, 1).told()
    both = campaign.Run(("matched-filter", "capon"), ("2",), 1, radar=radar, layout=(0, 1, 9, 85))
    assert campaign.hearing(both).methods == ("matched-filter",)
    with pytest.raises(ValueError, match="capon: it hears the two ends"):
        campaign.hearing(campaign.Run(("capon",), ("2",), 1, radar=radar, layout=(0, 1, 9, 85)))


FAILS = """
import numpy as np
import apertura as ap

def own(ends, radar):
    if ends[0, 0, 0].real < 0:
        raise ArithmeticError("a negative sample")
    return np.zeros((radar.samples, radar.elements))

ap.serve(own, name="sometimes", eta=0.5)
"""


def test_a_failure_is_a_row_with_the_error(tmp_path):
    pytest.importorskip("distributed")
    (tmp_path / "own.py").write_text(FAILS)
    command = f"{sys.executable} {tmp_path / 'own.py'}"
    process = start(tmp_path, "--method-command", command, "--methods", "sometimes,baseline", "--sets", "2", "--count", "8")
    out, errors = process.communicate(timeout=240)
    assert process.returncode == 0, errors
    fails = [i for i in range(8) if ap.Scene.random("2", 0, i).simulate().ends[0, 0, 0].real < 0]
    assert 0 < len(fails) < 8
    with (tmp_path / "rows.errors.csv").open() as file:
        found = list(csv.DictReader(file))
    assert [int(row["index"]) for row in found] == fails
    assert all(row["method"] == "sometimes" and "ArithmeticError: a negative sample" in row["error"] for row in found)
    rows = ap.read_rows(tmp_path / "rows.csv")
    assert sorted(row["index"] for row in rows if row["method"] == "sometimes") == sorted({*range(8)} - {*fails})
    assert [row["index"] for row in rows if row["method"] == "baseline"] == [*range(8)]
    assert f"{len(fails)} of them errors" in out


def test_another_campaign_s_journal_is_kept(tmp_path):
    run = campaign.Run(METHODS, SETS, 3)
    path = tmp_path / "rows.csv.journal"
    _journal.Journal(path, run.told()).close()
    before = path.read_bytes()
    with pytest.raises(ValueError, match="of another campaign: seed is 0 there and 7 here"):
        _journal.Journal(path, campaign.Run(METHODS, SETS, 3, seed=7).told())
    path.write_bytes(before + b"rubbish\n")
    with pytest.raises(ValueError, match="line 2 is no row"):
        _journal.Journal(path, run.told())
    assert path.read_bytes() == before + b"rubbish\n"


def test_unusable_campaigns_are_told(tmp_path):
    (tmp_path / "there.csv").write_text("mine")
    for arguments, words in (
        (["--methods", "magic", "--sets", "1", "--count", "1", "--out", "rows.csv"], 'unknown method "magic"'),
        (["--methods", "baseline", "--sets", "magic", "--count", "1", "--out", "rows.csv"], "magic"),
        (["--methods", "baseline", "--sets", "1", "--count", "0", "--out", "rows.csv"], "count is 0"),
        (["--methods", "baseline", "--sets", "1", "--count", "1", "--out", "rows.txt"], ".csv or .parquet"),
        (["--methods", "baseline", "--sets", "1", "--count", "1", "--out", "there.csv"], "is there already"),
        (["--sets", "1", "--count", "1", "--out", "rows.csv"], "--methods or --method-command"),
    ):
        found = subprocess.run([sys.executable, "-m", "apertura.campaign", *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert found.returncode != 0 and words in found.stderr, found.stderr
    assert (tmp_path / "there.csv").read_text() == "mine" and sorted(os.listdir(tmp_path)) == ["there.csv"]


FULL = """
import resource, signal, sys
from pathlib import Path
import apertura as ap
from apertura import _journal, campaign
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
rows = ap.evaluate(["baseline"], ["1"], count=1)
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
journal = _journal.Journal(Path("rows.csv.journal"), campaign.Run(("baseline",), ("1",), 1000).told())
try:
    for index in range(1000):
        journal.add([{**rows[0], "index": index}])
except OSError as error:
    print("told:", error)
"""


def test_a_journal_can_be_read_after_a_full_disk(tmp_path):
    found = subprocess.run([sys.executable, "-c", FULL], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert found.stdout.startswith("told:"), found
    journal = _journal.Journal(tmp_path / "rows.csv.journal", campaign.Run(("baseline",), ("1",), 1000).told())
    assert 1 < len(journal.rows) < 20


def test_a_device_is_no_journal():
    with pytest.raises(ValueError, match="is no file"):
        _journal.Journal(Path("/dev/full"), campaign.Run(METHODS, SETS, 1).told())
