"""The same bits as the program's, and opening its window."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import apertura as ap
from apertura import program

#: The program to compare with; built by `cargo build`, for instance.
PROGRAM = os.environ.get("APERTURA_PROGRAM") or shutil.which("apertura")


@pytest.mark.skipif(PROGRAM is None, reason="needs the program: set APERTURA_PROGRAM to its path")
@pytest.mark.parametrize("floor", ["thesis", "exact", "snr=20"])
def test_maps_have_the_bits_of_the_program(tmp_path, floor):
    scene = ap.Scene.random("3", seed=7, index=2)
    scene.save(tmp_path / "scene.toml")
    subprocess.run([PROGRAM, "maps", "scene.toml", "-o", "maps.npz", "--floor", floor, "--method", "live"], cwd=tmp_path, check=True)
    archive = np.load(tmp_path / "maps.npz")
    maps = scene.simulate(floor=floor)
    for key, end in (("sub0", maps.ends[0]), ("sub1", maps.ends[1])):
        assert np.array_equal(archive[key], end.T), key
    assert np.array_equal(archive["polar_full"][0], maps.decades)
    found = ap.method("live").reconstruct(maps.ends, floor=floor)
    assert np.array_equal(archive["output"][0], found.map)


@pytest.mark.skipif(PROGRAM is None, reason="needs the program: set APERTURA_PROGRAM to its path")
def test_rows_have_the_figures_of_the_program(tmp_path):
    arguments = ["evaluate", "--method", "baseline,live", "--set", "2", "--count", "2", "--rows", "rows.csv"]
    subprocess.run([PROGRAM, *arguments], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    theirs = ap.read_rows(tmp_path / "rows.csv")
    own = ap.evaluate(["baseline", "live"], ["2"], count=2)
    key = lambda row: (row["index"], row["method"])
    for a, b in zip(sorted(theirs, key=key), sorted(own, key=key), strict=True):
        a.pop("milliseconds"), b.pop("milliseconds")
        assert a == b


@pytest.mark.skipif(PROGRAM is None, reason="needs the program: set APERTURA_PROGRAM to its path")
def test_the_search_answers_as_that_of_the_program(tmp_path):
    """On clusters the search amplifies a difference in the last bit of its least squares to another answer."""
    arguments = ["evaluate", "--method", "nomp", "--set", "clusters", "--count", "20", "--rows", "rows.csv"]
    subprocess.run([PROGRAM, *arguments], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    theirs = {row["index"]: row["squared_error"] for row in ap.read_rows(tmp_path / "rows.csv")}
    own = {row["index"]: row["squared_error"] for row in ap.evaluate(["nomp"], ["clusters"], count=20)}
    assert len(own) == 20 and theirs == own


def test_the_window_opens_on_a_scene(tmp_path, monkeypatch):
    monkeypatch.delenv("APERTURA_PROGRAM", raising=False)
    script = tmp_path / "apertura"
    script.write_text(f'#!/bin/sh\ncp "$1" {tmp_path}/seen.toml\n')
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "elsewhere" / "python"))
    scene = ap.Scene.random("2")
    assert ap.open(scene).wait(30) == 0
    assert ap.Scene.load(tmp_path / "seen.toml") == scene
    with pytest.raises(FileNotFoundError, match="no such file"):
        ap.open(tmp_path / "nothing.toml")


@pytest.mark.skipif(sys.platform == "win32", reason="the program is a script of a shell")
@pytest.mark.parametrize(
    "wait, does, stays",
    [
        (".wait(30)", "", False),
        ("", "sleep 0.5", False),
        (".wait(30)", 'sleep 0.1; echo "# saved" >> "$1"', True),
    ],
)
def test_the_scene_of_a_window_is_removed_in_the_end(tmp_path, wait, does, stays):
    script = tmp_path / "window"
    script.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/path\n{does}\ncat "$1" > {tmp_path}/seen.toml\n')
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    environment = {**os.environ, "APERTURA_PROGRAM": str(script), "TMPDIR": str(tmp_path)}
    subprocess.run([sys.executable, "-c", f'import apertura as ap; ap.open(ap.Scene(name="seen")){wait}'], env=environment, check=True, timeout=60)
    assert 'name = "seen"' in (tmp_path / "seen.toml").read_text()
    scene = Path((tmp_path / "path").read_text().strip())
    assert scene.parent.parent == tmp_path and scene.exists() == stays and scene.parent.exists() == stays


def test_a_missing_program_is_told(tmp_path, monkeypatch):
    monkeypatch.delenv("APERTURA_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    with pytest.raises(FileNotFoundError, match="cargo install"):
        program.find_program()
    with pytest.raises(FileNotFoundError, match="cargo install"):
        ap.open(ap.Scene())


def test_the_program_of_a_wheel_is_found_where_pip_put_it(tmp_path, monkeypatch):
    monkeypatch.delenv("APERTURA_PROGRAM", raising=False)
    placed = tmp_path / "user" / "bin" / program._NAME

    class Placed:
        name = program._NAME

        def locate(self):
            return tmp_path / "user" / "lib" / ".." / "bin" / program._NAME

    monkeypatch.setattr(program.importlib.metadata, "files", lambda name: [Placed()])
    monkeypatch.setattr(program.sys, "executable", str(tmp_path / "nowhere" / "python"))
    monkeypatch.setenv("PATH", "")
    with pytest.raises(FileNotFoundError):
        program.find_program()
    placed.parent.mkdir(parents=True)
    placed.write_text("")
    placed.chmod(placed.stat().st_mode | stat.S_IXUSR)
    assert program.find_program() == str(placed)


def test_the_program_that_is_named_is_found(tmp_path, monkeypatch):
    named = tmp_path / "mine"
    named.write_text("#!/bin/sh\n")
    monkeypatch.setenv("APERTURA_PROGRAM", str(named))
    with pytest.raises(FileNotFoundError, match="APERTURA_PROGRAM is .*mine, which is no program"):
        program.find_program()
    named.chmod(named.stat().st_mode | stat.S_IXUSR)
    assert program.find_program() == str(named)
