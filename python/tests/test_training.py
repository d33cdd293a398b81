"""The training programs, in one process and under torchrun. They need PyTorch."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

TRAINING = Path(__file__).parents[2] / "training"
if not TRAINING.exists():
    pytest.skip("the training programs are in the repository alone", allow_module_level=True)
for module in ("torch", "safetensors"):
    pytest.importorskip(module)

import torch  # noqa: E402

LIVE = ("train_live.py", "--batch", "1", "--validation", "0")
THESIS = ("train_thesis.py", "--experiment", "2", "--validation", "0", "--whole-from", "0")


def alone(folder, program, *arguments):
    command = [sys.executable, str(TRAINING / program), "--out", str(folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def torchrun(folder, *command, restarts=0):
    options = ["--standalone", "--nproc-per-node", "2", "--max-restarts", str(restarts), "--monitor-interval", "0.1"]
    command = [sys.executable, "-m", "torch.distributed.run", *options, *map(str, command), "--out", str(folder)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


def steps(folder):
    lines = (folder / "log.csv").read_text().splitlines()
    assert lines[0] == "step,epoch,maps,seconds,learning_rate,loss,smoothed_loss"
    return [int(line.split(",")[0]) for line in lines[1:]]


def weights(folder):
    return torch.load(folder / "checkpoint.pt", weights_only=True)


@pytest.mark.parametrize("program", [LIVE, THESIS], ids=["live", "thesis"])
def test_a_run_goes_on_from_its_checkpoint(tmp_path, program):
    for until in ("1", "2"):
        found = alone(tmp_path, *program, "--steps", until)
        assert found.returncode == 0, found.stderr
    assert steps(tmp_path) == [1, 2] and weights(tmp_path)["step"] == 2


def test_two_processes_take_the_steps_of_one(tmp_path):
    process = torchrun(tmp_path / "two", TRAINING / LIVE[0], *LIVE[1:], "--steps", "2")
    _, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    found = alone(tmp_path / "one", "train_live.py", "--batch", "2", "--validation", "0", "--steps", "2")
    assert found.returncode == 0, found.stderr
    two, one = weights(tmp_path / "two"), weights(tmp_path / "one")
    assert two["drawn"] == one["drawn"] == 4 and two["maps"] == one["maps"] == 4
    off = [(two["model"][name] - one["model"][name]).abs().max() for name in one["model"]]
    # Adam's first steps have the size of the rate wherever a gradient isn't zero, so that a last bit of it can turn one.
    assert max(off) < 2e-5 and sum(off) / len(off) < 2e-6


#: Starts a training program and writes down which examples each start of it asks for.
COUNTED = """
import os, runpy, sys
import apertura as ap

make = ap.torch.Scenes.__getitems__

def counted(data, indices):
    with open(os.environ["EXAMPLES"], "a") as file:
        file.write("".join(f"{os.environ['TORCHELASTIC_RESTART_COUNT']} {index}\\n" for index in indices))
    return make(data, indices)

ap.torch.Scenes.__getitems__ = counted
del sys.argv[0]
sys.path.insert(0, os.path.dirname(sys.argv[0]))
runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.parametrize(("program", "rank"), [(LIVE, "1"), (THESIS, "0")], ids=["live", "thesis"])
def test_a_killed_process_costs_the_steps_behind_the_checkpoint(tmp_path, monkeypatch, program, rank):
    folder, examples = tmp_path / "run", tmp_path / "examples"
    found = alone(folder, *program, "--steps", "2")
    assert found.returncode == 0, found.stderr
    first = drawn(folder)
    monkeypatch.setenv("EXAMPLES", str(examples))
    (tmp_path / "counted.py").write_text(COUNTED)
    # Two processes go on from step 2, and keep nothing before the end.
    process = torchrun(folder, tmp_path / "counted.py", TRAINING / program[0], *program[1:], "--steps", "6", "--save-every", "60", restarts=1)
    deadline = time.monotonic() + 300
    while time.monotonic() < deadline and steps(folder)[-1] < 4:
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)
    assert weights(folder)["step"] == 2
    [killed] = [pid for pid in children(process.pid) if environment(pid).get("RANK") == rank]
    os.kill(killed, signal.SIGKILL)
    out, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    assert f"restart 1 of 2 processes: going on from step 2 of {folder / 'checkpoint.pt'}" in out
    assert steps(folder) == [1, 2, 3, 4, 5, 6] and weights(folder)["step"] == 6
    last = json.loads(weights(folder)["parts"])[-1]
    assert last["restarts"] == 1 and last["processes"] == 2
    asked = [tuple(map(int, line.split())) for line in examples.read_text().splitlines()]
    lost, kept = ([index for restart, index in asked if restart == number] for number in (0, 1))
    # The steps behind the checkpoint are taken again, with their examples. No other example comes twice.
    assert sorted(kept) == [*range(first, drawn(folder))]
    assert len(lost) == len({*lost}) and {*lost} <= {*kept} and max(lost) > first


def drawn(folder):
    """How many examples the run of this folder has drawn."""
    state = weights(folder)
    return state["drawn"] if "drawn" in state else state["scenes"]


def children(pid):
    found = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in found] + [grand for child in found for grand in children(child)]


def environment(pid):
    return dict(entry.split("=", 1) for entry in Path(f"/proc/{pid}/environ").read_text().split("\0") if "=" in entry)


def test_scenes_of_a_pool_are_drawn_several_times(tmp_path):
    found = alone(tmp_path, "train_live.py", "--batch", "2", "--validation", "0", "--steps", "16", "--pool", "32", "--uses", "1", "--log-every", "8")
    assert found.returncode == 0, found.stderr
    # A chunk of 32 scenes is used up by 16 batches of two.
    assert steps(tmp_path) == [8, 16]
    state = weights(tmp_path)
    assert state["maps"] == 32 and state["drawn"] >= 32 and state["drawn"] % 32 == 0
    found = alone(tmp_path, "train_live.py", "--batch", "8", "--pool", "4", "--steps", "1")
    assert found.returncode != 0 and "at least --batch (8) scenes" in found.stderr


def test_minutes_leave_validation_out(tmp_path):
    program = Path(TRAINING, "common.py")
    script = f"import sys; sys.path.insert(0, {str(program.parent)!r}); import time; from common import Clock; c = Clock()\n"
    script += "with c.stopped():\n    time.sleep(0.5)\nassert c.seconds() < 0.3, c.seconds()"
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=600)
    assert found.returncode == 0, found.stderr


def test_what_can_not_train_is_told_in_a_line(tmp_path):
    for arguments, told in ((("--mixture", "hills"), 'no scenes called "hills"'), (("--init", "none.safetensors"), "--init none.safetensors: there is no such file")):
        found = alone(tmp_path, *LIVE, "--steps", "1", *arguments)
        assert found.returncode != 0 and told in found.stderr and "Traceback" not in found.stderr


def test_wrong_files_are_told_in_a_line(tmp_path):
    text, other = tmp_path / "text.toml", tmp_path / "other.safetensors"
    text.write_text("mine")
    from safetensors.torch import save_file

    save_file({"a": torch.zeros(3)}, other)
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "checkpoint.pt").write_text("mine")
    torch.save({"model": {}}, tmp_path / "checkpoint.pt")
    for folder, arguments, told in (
        ("new", ("--radar", str(text)), "text.toml: line 1"),
        ("new", ("--radar", "nowhere.toml"), "--radar nowhere.toml: there is no such file"),
        ("new", ("--init", str(text)), "text.toml is no weight file"),
        ("new", ("--init", str(other)), "other.safetensors holds weights of another network"),
        ("run", (), "checkpoint.pt is no checkpoint"),
        (".", (), 'checkpoint.pt is no checkpoint of train_live.py: it has no "doubt"'),
    ):
        found = alone(tmp_path / folder, *LIVE, "--steps", "1", *arguments)
        assert found.returncode != 0 and told in found.stderr and "Traceback" not in found.stderr, found.stderr
    found = alone(tmp_path, "train_live.py", "--judge", str(other))
    assert found.returncode != 0 and "another network" in found.stderr and "Traceback" not in found.stderr


def test_a_checkpoint_is_light_and_has_what_adam_needs(tmp_path):
    for until in ("1", "2"):
        found = alone(tmp_path, *LIVE, "--steps", until)
        assert found.returncode == 0, found.stderr
    assert (tmp_path / "checkpoint.pt").stat().st_size < 15 << 20
    [*moments] = weights(tmp_path)["optimizer"]["state"].values()
    assert {m["exp_avg"].dtype for m in moments} == {torch.bfloat16} and {m["exp_avg_sq"].dtype for m in moments} == {torch.float32}


def test_a_radar_of_another_shape_trains_a_network_of_its_shape(tmp_path):
    import apertura as ap
    from apertura.live import Estimator

    radar = ap.Radar(elements=86, end_elements=8, samples=128, convention="physical")
    ap.Scene(radar=radar).save(tmp_path / "radar.toml")
    own = ("train_live.py", "--batch", "2", "--validation", "0", "--radar", str(tmp_path / "radar.toml"), "--tiny")
    found = alone(tmp_path / "run", *own, "--steps", "2")
    assert found.returncode == 0, found.stderr
    found = alone(tmp_path / "run", *LIVE, "--steps", "3")
    assert found.returncode != 0 and "--radar and --tiny ask for {}" in found.stderr
    path = tmp_path / "own.safetensors"
    found = alone(tmp_path / "run", *own[:-5], "--radar", str(tmp_path / "radar.toml"), "--tiny", "--validation", "1", "--export", str(path))
    assert found.returncode == 0, found.stderr
    estimator = Estimator(path)
    assert estimator.radar == radar and estimator.__name__ == "live-own"
    engine = ap.method("live", weights=path, called="engine")
    rows = ap.evaluate([estimator, engine, "baseline"], ["2"], count=1, radar=radar)
    assert [row["method"] for row in rows] == ["live-own", "engine", "baseline"]
    assert rows[0]["squared_error"] == pytest.approx(rows[1]["squared_error"], rel=1e-2), "the program's engine answers the same"
    with pytest.raises(ValueError, match="the weights are for"):
        ap.evaluate([estimator], ["2"], count=1, radar=radar.replace(carrier_hz=76e9))
    method = ap.Method.of_command(f'"{sys.executable}" -m apertura.live "{path}"')
    assert method.name == "live-own" and len(method.weights) == 12
    found = alone(tmp_path / "odd", "train_live.py", "--steps", "1", "--radar", str(odd(tmp_path)))
    assert found.returncode != 0 and "expected a multiple of 8" in found.stderr


def odd(folder):
    """The file of a radar whose samples can't be halved three times."""
    import apertura as ap

    ap.Scene(radar=ap.Radar(elements=64, end_elements=8, samples=36)).save(folder / "odd.toml")
    return folder / "odd.toml"


def test_weights_are_exported(tmp_path):
    assert alone(tmp_path, *LIVE, "--steps", "1").returncode == 0
    path = tmp_path / "live.safetensors"
    found = alone(tmp_path, "train_live.py", "--validation", "1", "--export", str(path))
    assert found.returncode == 0, found.stderr
    from safetensors import safe_open

    with safe_open(path, "pt") as file:
        assert file.metadata()["network"] == "live" and "set 3: SE" in file.metadata()["validation"]
        assert "limits" in json.loads(file.metadata()["domain"])


def test_untrained_weights_are_not_exported(tmp_path):
    found = alone(tmp_path, "train_live.py", "--export", str(tmp_path / "live.safetensors"))
    assert found.returncode != 0 and "saw no map" in found.stderr


def test_the_comparison_takes_the_shipped_weights(monkeypatch):
    monkeypatch.syspath_prepend(TRAINING.parent / "comparisons")
    import network

    shipped = network.shipped()
    with torch.no_grad():
        decades, minimum = shipped.live()(**shipped.inputs())
    assert decades.shape == (1, 512, 1024) and minimum.shape == (1,) and bool(torch.isfinite(decades).all())
