"""Trains the thesis' encoder-decoder at the width that two cores can train: the PyTorch twin of
`apertura train experiment-1-small` and `experiment-2-small`, several times as fast on a CPU.

    python3 train_thesis.py --experiment 1 --out DIR --minutes 60    # start, or go on from DIR/checkpoint.pt
    torchrun --nproc-per-node 2 --max-restarts 3 \\
        train_thesis.py --experiment 1 --out DIR --minutes 60        # the same in two processes, whose gradients are averaged
    python3 train_thesis.py --experiment 1 --out DIR --init FILE     # start from a weight file (.safetensors) with its record, or from another run's
                                                                     # checkpoint (.pt), its scenes included too, with a new optimizer
    python3 train_thesis.py --experiment 1 --out DIR --validation 24 \\
        --export ../assets/weights/thesis-1.safetensors              # write the averaged weights and their figures, and stop

Needs torch, numpy, safetensors and apertura (`pip install ../python`), which makes the scenes. Scenes and loss are those of the experiments. What differs, so that hours on two cores are enough to learn something:

* AdamW in place of SGD: with it 12 minutes gave what SGD at the thesis' 0.1 gave after 42. With `--muon` the kernels follow Muon instead,
  whose loss is 5 % lower after 250 steps on the same maps. With `--bf16` a step takes half the time where the processor has bfloat16.
* The learning rate rises over 100 steps and then falls with the square root of the steps of this run, so that a run needs no end; a moving
  average of the weights is what is validated and written.
* Every scene is new, where the thesis goes over 800 or 8000 scenes a hundred times. Each process simulates one a step.
* Until `--whole-from` a batch holds 8 crops of 128 range rows from the newest 64 scenes, later 2 whole maps: crops see no wrap in range.
* The last batch norm starts at 0.45 +- 0.15, about where the targets lie. From PyTorch's 0 +- 1 half of the cells start below zero,
  where the ReLU behind it lets no gradient through, and 240 steps did not bring them back.
* The exported statistics of the batch norms are those of 32 whole training maps.

A checkpoint holds weights, their average, optimizer, and the record of every part of the run. When a process is killed, torchrun starts all of
them again from it. Training and validation scenes come from streams that never meet. `log.csv` has the loss, as `apertura train` writes it;
`validation.jsonl` has SE and P_D over maps seen (a crop is a quarter of a map).
"""
import json
import os

import options

if __name__ == "__main__":
    ARGUMENTS = options.thesis()  # before PyTorch, which takes seconds to load

import numpy as np
import torch

import apertura as ap
import provenance
from common import LEARNED, TARGET, Clock, export, figures, loaded, save, stacked, tensors_of, unit, validation_scenes
from muon import Muon
from team import Log, Team
from thesis import Thesis

FILTERS = 16
CROPS, WHOLE = 8, 2
ROWS, CROP = 512, 128
BUFFER = 64
WARM_UP = 100


#: Kinds of scenes of each experiment: one to four objects, each as often.
MIXTURE = {1: "points", 2: "mixed"}


def training_scenes(experiment):
    mixture = ",".join(f"{MIXTURE[experiment]}-{objects}=1" for objects in range(1, 5))
    return ap.torch.Scenes(mixture, experiment, length=1 << 32, network="thesis", targets=[TARGET])


def entry(example):
    """Input [4, 512, 1024] and target [512, 1024]."""
    return example["mag_phase"], unit(example[LEARNED][None])[0]


def crop(entry, rng):
    top = int(rng.integers(ROWS - CROP + 1))
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
    def estimate(batch):
        target = unit(batch[LEARNED])
        model.eval()
        output = model(batch["mag_phase"].contiguous(memory_format=torch.channels_last))[:, 0]
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
    scenes = training_scenes(experiment)
    for first in range(0, 32, 4):
        model(stacked(scenes.__getitems__(range(first, first + 4)))["mag_phase"])


def state_of(path):
    """What another run's checkpoint or a weight file holds: "model", and of a run where it stands."""
    if path.endswith(".safetensors"):
        parts = provenance.parts_of(path)
        return {"model": tensors_of(path), "parts": json.dumps(parts), "maps": provenance.maps_of(parts)}
    return loaded(path, "cpu", ("model",), "train_thesis.py")


def optimizers(model, lr, muon):
    """AdamW for all parameters, or Muon for the kernels and AdamW for the rest."""
    adam = lambda parameters: torch.optim.AdamW(parameters, lr=lr, weight_decay=1e-4, betas=(0.9, 0.99))
    if not muon:
        return [adam(model.parameters())]
    return [Muon([p for p in model.parameters() if p.ndim == 4], lr), adam([p for p in model.parameters() if p.ndim != 4])]


class Run:
    """Weights, their average, optimizers and record, as a checkpoint holds them."""

    def __init__(self, args, team):
        self.path = os.path.join(args.out, "checkpoint.pt")
        self.model, self.average = fresh().to(team.device), fresh().to(team.device)
        self.step, self.maps, self.scenes, self.parts, initial, state = 0, 0.0, 0, [], None, None
        if os.path.exists(self.path):
            state = loaded(self.path, team.device, ("model", "average", "optimizers", "step"), "train_thesis.py")
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

    def rate(self, lr):
        return lr * min((self.step + 1) / WARM_UP, (1 + self.step / 1000) ** -0.5)

    def advance(self, rate):
        """One step down the gradient that was computed."""
        for optimizer in self.optimizers:
            for group in optimizer.param_groups:
                group["lr"] = rate
            optimizer.step()
        self.follow()
        self.step += 1

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


class Buffer:
    """This process' newest scenes, and batches of them."""

    def __init__(self, run, args, team):
        self.scenes, self.args, self.team, self.entries = training_scenes(args.experiment), args, team, []
        self.next = run.scenes

    def batch(self, run):
        """Inputs, targets and how many maps they are."""
        for _ in range(1 if self.entries else CROPS):
            self.entries.append(entry(self.scenes[self.next + self.team.rank]))
            self.next += self.team.size
        self.entries = self.entries[-BUFFER:]
        pick = np.random.default_rng([self.args.experiment, self.next, self.team.rank])
        whole = run.step >= self.args.whole_from
        chosen = [self.entries[pick.integers(len(self.entries))] for _ in range(WHOLE if whole else CROPS)]
        inputs, target = batch_of(chosen if whole else [crop(e, pick) for e in chosen])
        return inputs.to(self.team.device), target.to(self.team.device), WHOLE if whole else CROPS * CROP / ROWS


def train(run, args, team):
    run.model.train()
    sets = validation_scenes(args.experiment, args.validation, network="thesis") if team.is_first and args.validation else None
    clock = Clock()
    log = Log(args.out, run.step) if team.is_first else None
    model, buffer = team.share(run.model), Buffer(run, args, team)
    saved, validated = 0.0, float("-inf")
    while True:
        seconds = team.agreed(clock.seconds())
        done = run.step >= args.steps if args.steps is not None else seconds > 60 * args.minutes
        if team.is_first and (done or seconds - saved >= 60 * args.save_every):
            run.save()
            saved = seconds
        if sets and (done or seconds - validated > 60 * args.validate_every):
            with clock.stopped():
                report = figures(estimate_with(run.average.cpu()), sets)
            run.average.to(team.device)
            line = json.dumps({"step": run.step, "maps": run.maps, "loss": log.smoothed, **report})
            with open(os.path.join(args.out, "validation.jsonl"), "a") as f:
                f.write(line + "\n")
            team.say(line)
            validated = seconds
        if done:
            return
        inputs, target, maps = buffer.batch(run)
        with torch.autocast(team.device.type, torch.bfloat16, enabled=args.bf16):
            output = model(inputs)[:, 0]
        loss = loss_of(args.experiment, output.float(), target)
        run.model.zero_grad(set_to_none=True)
        loss.backward()
        mean = team.mean(loss.item())
        if not mean < float("inf"):
            raise SystemExit(f"loss is {mean} at step {run.step}; the last good checkpoint is in {args.out}")
        rate = run.rate(args.lr)
        run.advance(rate)
        run.scenes = buffer.next
        run.maps += maps * team.size
        if log:
            log.line(run.step, run.maps, clock.seconds(), rate, mean)


def main(args):
    torch.manual_seed(args.experiment)
    team = Team(args.threads)
    os.makedirs(args.out, exist_ok=True)
    run = Run(args, team)
    options.refuse_untrained(args, run.maps)
    if args.export:
        sets = validation_scenes(args.experiment, args.validation, network="thesis")
        settle(run.average, args.experiment)
        report = figures(estimate_with(run.average), sets)
        meta = {"network": "thesis", "recipe": f"experiment-{args.experiment}-small", "trainer": "training/train_thesis.py (PyTorch)",
                "seed": str(args.experiment), "steps": str(run.step), **provenance.metadata(run.parts)}
        export({k: v for k, v in run.average.state_dict().items() if not k.endswith("num_batches_tracked")},
               args.export, meta, report, args.validation)
        return
    if team.restarts:
        team.say(f"restart {team.restarts} of {team.size} processes: going on from step {run.step} of {run.path}")
    train(run, args, team)
    team.end()


if __name__ == "__main__":
    main(ARGUMENTS)
