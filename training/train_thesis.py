"""Trains the thesis' encoder-decoder at the width that two cores can train: the PyTorch twin of
`apertura train experiment-1-small` and `experiment-2-small`, several times as fast on a CPU.

    python3 train_thesis.py --experiment 1 --out DIR --minutes 60    # start, or go on from DIR/checkpoint.pt
    python3 train_thesis.py --experiment 1 --out DIR --init FILE     # start from a weight file (.safetensors) with its record, or from another run's
                                                                     # checkpoint (.pt), its scenes included too, with a new optimizer
    python3 train_thesis.py --experiment 1 --out DIR --validation 24 \\
        --export ../assets/weights/thesis-1.safetensors              # write the averaged weights and their figures, and stop

Scenes and loss are those of the experiments. What differs, so that hours on two cores are enough to learn something:

* AdamW in place of SGD: with it 12 minutes gave what SGD at the thesis' 0.1 gave after 42. With `--muon` the kernels follow Muon instead,
  whose loss is 5 % lower after 250 steps on the same maps. With `--bf16` a step takes half the time where the processor has bfloat16.
* The learning rate rises over 100 steps and then falls with the square root of the steps of this run, so that a run needs no end; a moving
  average of the weights is what is validated and written.
* Every scene is new, where the thesis goes over 800 or 8000 scenes a hundred times. One is simulated a step.
* Until `--whole-from` a batch holds 8 crops of 128 range rows from the newest 64 scenes, later 2 whole maps: crops see no wrap in range.
* The last batch norm starts at 0.45 +- 0.15, about where the targets lie. From PyTorch's 0 +- 1 half of the cells start below zero,
  where the ReLU behind it lets no gradient through, and 240 steps did not bring them back.
* The exported statistics of the batch norms are those of 32 whole training maps.

A checkpoint holds weights, their average, optimizer, and the record of every part of the run. Training and validation scenes come from
generators with different keys. `log.jsonl` has SE and P_D over maps seen (a crop is a quarter of a map).
"""
import json
import os
import time

import options

if __name__ == "__main__":
    ARGUMENTS = options.thesis()  # before PyTorch, which takes seconds to load

import numpy as np
import torch

import provenance
import scenes as sc
from common import export, figures, save, unit, validation_scenes
from muon import Muon
from thesis import Thesis

FILTERS = 16
CROPS, WHOLE = 8, 2
CROP = 128
BUFFER = 64
WARM_UP = 100


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
    """For `common.figures`. The output is Lambda as it stands; for a threshold the thesis stretches it to [0, 1]."""
    def estimate(entries):
        inputs, target = batch_of(entries)
        model.eval()
        output = model(inputs)[:, 0]
        model.train()
        return output.clamp(0, 1), target, unit(output)
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


def state_of(path):
    """What another run's checkpoint or a weight file holds: "model", and of a run where it stands."""
    if path.endswith(".safetensors"):
        from safetensors.torch import load_file
        parts = provenance.parts_of(path)
        return {"model": load_file(path), "parts": json.dumps(parts), "maps": provenance.maps_of(parts)}
    return torch.load(path, weights_only=True)


def optimizers(model, lr, muon):
    """AdamW for all parameters, or Muon for the kernels and AdamW for the rest."""
    adam = lambda parameters: torch.optim.AdamW(parameters, lr=lr, weight_decay=1e-4, betas=(0.9, 0.99))
    if not muon:
        return [adam(model.parameters())]
    return [Muon([p for p in model.parameters() if p.ndim == 4], lr), adam([p for p in model.parameters() if p.ndim != 4])]


class Run:
    """Weights, their average, optimizers and record, as a checkpoint holds them."""

    def __init__(self, args):
        self.path = os.path.join(args.out, "checkpoint.pt")
        self.model, self.average = fresh(), fresh()
        self.step, self.maps, self.scenes, self.parts, initial, state = 0, 0.0, 0, [], None, None
        if os.path.exists(self.path):
            state = torch.load(self.path, weights_only=True)
            # A run goes on with the optimizers that it has.
            self.optimizers = optimizers(self.model, args.lr, muon=len(state["optimizers"]) > 1)
            self.average.load_state_dict(state["average"])
            for optimizer, saved in zip(self.optimizers, state["optimizers"], strict=True):
                optimizer.load_state_dict(saved)
            self.step = state["step"]
        else:
            self.optimizers = optimizers(self.model, args.lr, args.muon)
            if args.init:
                initial, state = args.init, state_of(args.init)
                self.average.load_state_dict(state.get("average", state["model"]), strict=False)
        if state:
            self.model.load_state_dict(state["model"], strict=False)
            self.maps, self.scenes = state.get("maps", 0.0), state.get("scenes", args.first_scene)
            self.parts = json.loads(state.get("parts", "[]"))
        self.part = provenance.Part(initial, self.maps, "Muon" if len(self.optimizers) > 1 else "AdamW")

    def records(self):
        return [*self.parts, self.part.now(self.maps)]

    def advance(self, loss, lr):
        """One step down the gradient of `loss`."""
        rate = lr * min((self.step + 1) / WARM_UP, (1 + self.step / 1000) ** -0.5)
        self.model.zero_grad(set_to_none=True)
        loss.backward()
        for optimizer in self.optimizers:
            for group in optimizer.param_groups:
                group["lr"] = rate
            optimizer.step()
        self.follow()

    @torch.no_grad()
    def follow(self):
        """Moves the average towards the weights, and its batch norms' statistics to theirs."""
        decay = min(0.999, (1 + self.step) / (10 + self.step))
        for a, p in zip(self.average.parameters(), self.model.parameters()):
            a.lerp_(p, 1 - decay)
        for a, p in zip(self.average.buffers(), self.model.buffers()):
            a.copy_(p)

    def save(self):
        save(self.path, {"model": self.model.state_dict(), "average": self.average.state_dict(), "optimizers": [o.state_dict() for o in self.optimizers],
                         "step": self.step, "maps": self.maps, "scenes": self.scenes, "parts": json.dumps(self.records())})


def train(run, args, sets):
    run.model.train()
    log = os.path.join(args.out, "log.jsonl")
    began = saved = time.time()
    validated, running, buffer = 0.0, None, []
    while True:
        done = time.time() - began > 60 * args.minutes
        if done or time.time() - validated > 60 * args.validate_every:
            report = figures(estimate_with(run.average), sets)
            with open(log, "a") as f:
                f.write(json.dumps({"maps": run.maps, "step": run.step, "loss": running, **report}) + "\n")
            print(f"step {run.step} maps {run.maps:.0f} loss {running} validation {report}", flush=True)
            validated = time.time()
        if done or time.time() - saved > 120:
            run.save()
            saved = time.time()
        if done:
            return
        for _ in range(1 if buffer else CROPS):
            buffer += entry(*scene(args.experiment, run.scenes))
            run.scenes += 1
        buffer = buffer[-BUFFER:]
        pick = np.random.default_rng([args.experiment, run.scenes])
        whole = run.step >= args.whole_from
        chosen = [buffer[pick.integers(len(buffer))] for _ in range(WHOLE if whole else CROPS)]
        inputs, target = batch_of(chosen if whole else [crop(e, pick) for e in chosen])
        with torch.autocast("cpu", torch.bfloat16, enabled=args.bf16):
            output = run.model(inputs)[:, 0]
        loss = loss_of(args.experiment, output.float(), target)
        if not torch.isfinite(loss):
            raise SystemExit(f"loss is not finite at step {run.step}; the last good checkpoint is in {args.out}")
        run.advance(loss, args.lr)
        run.step += 1
        run.maps += WHOLE if whole else CROPS * CROP / sc.N_R
        running = loss.item() if running is None else 0.98 * running + 0.02 * loss.item()


def main(args):
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.experiment)
    os.makedirs(args.out, exist_ok=True)
    run = Run(args)
    options.refuse_untrained(args, run.maps)
    sets = validation_scenes(args.experiment, args.validation, entry)
    if args.export:
        settle(run.average, args.experiment)
        report = figures(estimate_with(run.average), sets)
        meta = {"network": "thesis", "recipe": f"experiment-{args.experiment}-small", "trainer": "training/train_thesis.py (PyTorch)",
                "seed": str(args.experiment), "steps": str(run.step), **provenance.metadata(run.parts)}
        export({k: v for k, v in run.average.state_dict().items() if not k.endswith("num_batches_tracked")},
               args.export, meta, report, args.validation)
        return
    train(run, args, sets)


if __name__ == "__main__":
    main(ARGUMENTS)
