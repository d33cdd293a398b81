"""Trains the thesis' encoder-decoder at the width that two cores can train: the PyTorch twin of
`apertura train experiment-1-small` and `experiment-2-small`, which computes in bfloat16 and is several times as fast on a CPU.

    python3 train_thesis.py --experiment 1 --out DIR --minutes 60    # start, or go on from DIR/checkpoint.pt
    python3 train_thesis.py --experiment 1 --out DIR --validation 24 \\
        --export ../../assets/weights/thesis-1.safetensors           # write the weights and their figures, and stop

Scenes, loss, SGD at 0.1 with momentum 0.9 and batches of 8 are those of the experiments. What differs, so that an hour on two
cores is enough to learn something:

* A batch holds crops of 128 range rows from the newest 64 scenes, of which one is new in every step.
* The last batch norm starts at 0.45 +- 0.15, about where the targets lie. From PyTorch's 0 +- 1 half of the cells start below zero,
  where the ReLU behind it lets no gradient through, and 240 steps did not bring them back.
* The exported statistics of the batch norms are those of 32 whole training maps.
* The thesis multiplies its learning rate by 0.8 every ten of a hundred epochs; here it falls at the same parts of `--minutes` of
  wall-clock time, counted over all parts of a run, so that a run of any length ends as the thesis' does.

A checkpoint holds weights, optimizer, time and the number of steps. Training and validation scenes come from generators with
different keys.
"""
import argparse
import os
import time

import numpy as np
import torch

import scenes as sc
from common import export, figures, save, unit, validation_scenes
from thesis import Thesis

FILTERS = 16
BATCH = 8
CROP = 128
BUFFER = 64
#: Scenes an epoch, for each of one to four objects.
SCENES = {1: 4 * 200, 2: 4 * 2000}


def mag_phase(samples):
    """The network's input [4, 512, 1024] from samples [2, 12, 512]: Lambda cos(arg Y) and Lambda sin(arg Y) of both ends."""
    z = torch.fft.fft(samples * sc.hann(sc.N_R), norm="ortho").transpose(1, 2) * sc.hann(sc.N_E)
    y = torch.fft.fft(z, n=sc.N_A).roll(sc.N_A // 2, 2) / sc.N_A**0.5
    magnitude = y.abs() + 1e-20
    parts = unit(torch.log10(magnitude)) / magnitude * y
    return torch.stack([parts[0].real, parts[0].imag, parts[1].real, parts[1].imag]).float()


def entry(points, rng):
    y = sc.simulate(points, rng)
    return [(mag_phase(sc.ends(y)), unit(sc.log_map(y)[None])[0])]


def scene(experiment, index):
    """Scene `index` of the experiment: one to four objects, each as often."""
    rng = sc.rng_for("train", experiment, index)
    objects = 1 + index % 4
    if experiment == 1:
        return np.concatenate([sc.random_point(rng) for _ in range(objects)]), rng
    parts = [sc.random_point(rng) if rng.random() < 0.5 else sc.line(sc.line_start(rng)) for _ in range(objects)]
    return np.concatenate(parts), rng


def crop(entry, rng):
    top = int(rng.integers(sc.N_R - CROP + 1))
    return tuple(t[..., top : top + CROP, :] for t in entry)


def fresh():
    model = Thesis(FILTERS)
    last = model.up.upconv[-1][1]
    torch.nn.init.constant_(last.weight, 0.15)
    torch.nn.init.constant_(last.bias, 0.45)
    return model.to(memory_format=torch.channels_last)


def batch_of(entries):
    inputs, targets = (torch.stack(t) for t in zip(*entries))
    return inputs.contiguous(memory_format=torch.channels_last), targets


def loss_of(experiment, output, target):
    square = (output - target) ** 2
    return square.mean() if experiment == 1 else square.sum() / target.abs().sum()


def estimate_with(model):
    """For `common.figures`: Lambda of output and target."""
    def estimate(entries):
        inputs, target = batch_of(entries)
        model.eval()
        output = model(inputs)[:, 0]
        model.train()
        return unit(output), target
    return estimate


@torch.no_grad()
def settle(model, experiment):
    """Takes the statistics of every batch norm from whole maps of training scenes in place of a moving average over crops."""
    norms = [m for m in model.modules() if isinstance(m, torch.nn.BatchNorm2d)]
    for norm in norms:
        norm.reset_running_stats()
        norm.momentum = None
    model.train()
    for first in range(0, 32, 4):
        model(batch_of([e for i in range(first, first + 4) for e in entry(*scene(experiment, i))])[0])


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("--experiment", type=int, choices=[1, 2], required=True)
    ap.add_argument("--out", required=True)
    ap.add_argument("--minutes", type=float, default=60)
    ap.add_argument("--threads", type=int, default=1)
    ap.add_argument("--validation", type=int, default=4, help="validation scenes a set")
    ap.add_argument("--validate-every", type=float, default=10, help="minutes")
    ap.add_argument("--export", help="write the weights to this file, with their validation figures, and stop")
    args = ap.parse_args()
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.experiment)
    os.makedirs(args.out, exist_ok=True)
    path = os.path.join(args.out, "checkpoint.pt")

    model = fresh()
    optimizer = torch.optim.SGD(model.parameters(), lr=0.1, momentum=0.9)
    step, elapsed = 0, 0.0
    if os.path.exists(path):
        state = torch.load(path, weights_only=True)
        model.load_state_dict(state["model"])
        optimizer.load_state_dict(state["optimizer"])
        step, elapsed = state["step"], state["elapsed"]
    sets = validation_scenes(args.experiment, args.validation, entry)
    if args.export:
        settle(model, args.experiment)
        report = figures(estimate_with(model), sets)
        meta = {"network": "thesis", "recipe": f"experiment-{args.experiment}-small", "seed": str(args.experiment),
                "trainer": "benches/twin/train_thesis.py (PyTorch)", "steps": str(step), "scenes_seen": str(step), "crops_seen": str(step * BATCH),
                "minutes": f"{elapsed / 60:.0f}"}
        export({k: v for k, v in model.state_dict().items() if not k.endswith("num_batches_tracked")},
               args.export, meta, report, args.validation)
        return

    model.train()
    began = time.time() - elapsed
    saved = validated = time.time()
    total, running, buffer = 60 * args.minutes, None, []
    while elapsed < total:
        for number in range(step, step + 1) if buffer else range(max(0, step - BATCH + 1), step + 1):
            buffer += entry(*scene(args.experiment, number % SCENES[args.experiment]))
        buffer = buffer[-BUFFER:]
        pick = np.random.default_rng([args.experiment, step])
        inputs, target = batch_of([crop(buffer[pick.integers(len(buffer))], pick) for _ in range(BATCH)])
        for group in optimizer.param_groups:
            group["lr"] = 0.1 * 0.8 ** int(10 * min(elapsed / total, 0.999))
        with torch.autocast("cpu", torch.bfloat16):
            output = model(inputs)[:, 0].float()
        loss = loss_of(args.experiment, output, target)
        if not torch.isfinite(loss):
            raise SystemExit(f"loss is not finite at step {step}; the last good checkpoint is in {args.out}")
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        optimizer.step()
        step += 1
        elapsed = time.time() - began
        value = float(loss.detach())
        running = value if running is None else 0.95 * running + 0.05 * value
        if step % 20 == 0:
            print(f"step {step} lr {optimizer.param_groups[0]['lr']:.3f} loss {running:.5f} {elapsed / 60:.1f} min", flush=True)
        done = elapsed >= total
        if done or time.time() - validated > 60 * args.validate_every:
            print("validation", figures(estimate_with(model), sets), flush=True)
            validated = time.time()
        if done or time.time() - saved > 120:
            save(path, {"model": model.state_dict(), "optimizer": optimizer.state_dict(), "step": step, "elapsed": elapsed})
            saved = time.time()


if __name__ == "__main__":
    main()
