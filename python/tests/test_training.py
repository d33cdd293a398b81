"""The training programs, in one process and under torchrun. They need PyTorch."""

import json
import os
import re
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


def torchrun(folder, program, *arguments):
    command = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2", "--max-restarts", "3", "--monitor-interval", "0.1"]
    command += [str(TRAINING / program), "--out", str(folder), *arguments]
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
    process = torchrun(tmp_path / "two", *LIVE, "--steps", "2")
    _, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    found = alone(tmp_path / "one", "train_live.py", "--batch", "2", "--validation", "0", "--steps", "2")
    assert found.returncode == 0, found.stderr
    two, one = weights(tmp_path / "two"), weights(tmp_path / "one")
    assert two["drawn"] == one["drawn"] == 4 and two["maps"] == one["maps"] == 4
    off = [(two["model"][name] - one["model"][name]).abs().max() for name in one["model"]]
    # Adam's first steps have the size of the rate wherever a gradient isn't zero, so that a last bit of it can turn one.
    assert max(off) < 2e-5 and sum(off) / len(off) < 2e-6


@pytest.mark.parametrize("program", [LIVE, THESIS], ids=["live", "thesis"])
def test_a_killed_process_costs_the_steps_behind_the_checkpoint(tmp_path, program):
    process = torchrun(tmp_path, *program, "--steps", "6", "--save-every", "0")
    deadline = time.monotonic() + 300
    while time.monotonic() < deadline and not ((tmp_path / "checkpoint.pt").exists() and (tmp_path / "log.csv").exists() and len(steps(tmp_path)) >= 2):
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)
    [second] = [pid for pid in children(process.pid) if environment(pid).get("RANK") == "1"]
    os.kill(second, signal.SIGKILL)
    out, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    found = re.search(r"restart [1-3] of 2 processes: going on from step (\d+) of", out)
    assert found and 1 <= int(found[1]) <= 6, out
    assert steps(tmp_path) == [1, 2, 3, 4, 5, 6]
    last = json.loads(weights(tmp_path)["parts"])[-1]
    assert last["restarts"] >= 1 and last["processes"] == 2


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


def test_weights_are_exported(tmp_path):
    assert alone(tmp_path, *LIVE, "--steps", "1").returncode == 0
    path = tmp_path / "live.safetensors"
    found = alone(tmp_path, "train_live.py", "--validation", "1", "--export", str(path))
    assert found.returncode == 0, found.stderr
    from safetensors import safe_open

    with safe_open(path, "pt") as file:
        assert file.metadata()["network"] == "live" and "set 3: SE" in file.metadata()["validation"]


def test_untrained_weights_are_not_exported(tmp_path):
    found = alone(tmp_path, "train_live.py", "--export", str(tmp_path / "live.safetensors"))
    assert found.returncode != 0 and "saw no map" in found.stderr
