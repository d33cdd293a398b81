"""Trains the thesis' encoder-decoder, at the width that two cores can train or at the thesis' own (`--filters 64`): the PyTorch twin of
`apertura train experiment-2-small` and `experiment-2`, several times as fast on a CPU.

    python3 train_thesis.py --experiment 1 --out DIR --minutes 60    # start, or go on from DIR/checkpoint.pt
    torchrun --nproc-per-node 2 --max-restarts 3 \\
        train_thesis.py --experiment 1 --out DIR --minutes 60        # the same in two processes, whose gradients are averaged
    python3 train_thesis.py --experiment 1 --out DIR --init FILE     # start from a weight file (.safetensors) with its record, or from another run's
                                                                     # checkpoint (.pt), its scenes included too, with a new optimizer
    python3 train_thesis.py --experiment 2 --out DIR --filters 64 --minutes 10 --cool 4 --validation 0 --muon --bf16 --graph --batch 16 --lr 2e-3 \\
        --pool 6000 --uses 8 --log-every 20 --threads 4              # on a GPU that there is for twelve minutes; the same again goes on
    python3 train_thesis.py --experiment 1 --out DIR --validation 24 \\
        --export ../assets/weights/thesis-1.safetensors              # write the averaged weights and their figures, and stop

Needs torch, numpy, safetensors and apertura (`pip install ../python`), which makes the scenes. Scenes and loss are those of the experiments. What differs, so that hours on two cores are enough to learn something:

* AdamW in place of SGD: with it 12 minutes gave what SGD at the thesis' 0.1 gave after 42. With `--muon` the kernels follow Muon instead,
  whose loss is 5 % lower after 250 steps on the same maps. With `--bf16` a step takes half the time where the processor has bfloat16.
* The learning rate rises over 100 steps and then falls with the square root of the steps of this run, so that a run needs no end; with `--cool M` it
  falls to zero over the last M minutes. A moving average of the weights is what is validated and written.
* Every scene is new, where the thesis goes over 800 or 8000 scenes a hundred times. Each process simulates one a step; with `--pool` they are made
  beside the steps, and each is drawn `--uses` times.
* Until `--whole-from` a batch holds 8 crops of 128 range rows from the newest 64 scenes, later `--batch` whole maps: crops see no wrap in range.
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
from common import (LEARNED, TARGET, Clock, cooled, export, figures, fill, finite, folder_of, follow, loaded, refuse_graph_without_gpu, save, stacked, tensors_of,
                    unit, validation_scenes)
from graph import Replayed
from muon import Muon
from pool import Pool
from team import Log, Team
from thesis import Thesis

CROPS = 8
ROWS, CROP = 512, 128
BUFFER = 64
WARM_UP = 100


#: Kinds of scenes of each experiment: one to four objects, each as often.
MIXTURE = {1: "points", 2: "mixed"}


def training_scenes(experiment):
    """Examples of the networks' input `mag_phase` [4, 512, 1024] and of Lambda, `truth` [512, 1024]."""
    mixture = ",".join(f"{MIXTURE[experiment]}-{objects}=1" for objects in range(1, 5))
    pair = lambda example: {"mag_phase": example["mag_phase"], "truth": unit(example[LEARNED][None])[0]}
    return ap.torch.Scenes(mixture, experiment, length=1 << 32, network="thesis", targets=[TARGET], transform=pair)


def crop(entry, rng):
    top = int(rng.integers(ROWS - CROP + 1))
    return {name: t[..., top : top + CROP, :] for name, t in entry.items()}


def fresh(filters):
    model = Thesis(filters)
    last = model.up.upconv[-1][1]
    torch.nn.init.constant_(last.weight, 0.15)
    torch.nn.init.constant_(last.bias, 0.45)
    return model.to(memory_format=torch.channels_last)


def loss_of(experiment, output, target):
    square = (output - target) ** 2
    return square.mean() if experiment == 1 else square.sum() / target.abs().sum()


def estimate_with(model, device="cpu"):
    """For `common.figures`. The output is Lambda as it stands; for a threshold the thesis stretches it to [0, 1]."""
    def estimate(batch):
        target = unit(batch[LEARNED].to(device))
        model.eval()
        output = model(batch["mag_phase"].to(device).contiguous(memory_format=torch.channels_last))[:, 0]
        model.train()
        return output.clamp(0, 1), target, unit(output)
    return estimate


@torch.no_grad()
def settle(model, experiment, device):
    """Takes the statistics of every batch norm from whole maps of training scenes in place of a moving average over crops."""
    norms = [m for m in model.modules() if isinstance(m, torch.nn.BatchNorm2d)]
    for norm in norms:
        norm.reset_running_stats()
        norm.momentum = None
    model.train()
    scenes = training_scenes(experiment)
    for first in range(0, 32, 4):
        model(stacked(scenes.__getitems__(range(first, first + 4)))["mag_phase"].to(device))


def state_of(path):
    """What another run's checkpoint or a weight file holds: "model", and of a run where it stands."""
    if path.endswith(".safetensors"):
        parts = provenance.parts_of(path)
        return {"model": tensors_of(path), "parts": json.dumps(parts), "maps": provenance.maps_of(parts)}
    return loaded(path, "cpu", ("model",), "train_thesis.py")


def optimizers(model, muon, **kept):
    """AdamW for all parameters, or Muon for the kernels and AdamW for the rest. `kept` are the rate, and what a recorded step needs."""
    adam = lambda parameters: torch.optim.AdamW(parameters, weight_decay=1e-4, betas=(0.9, 0.99), **kept)
    if not muon:
        return [adam(model.parameters())]
    return [Muon([p for p in model.parameters() if p.ndim == 4], kept["lr"]), adam([p for p in model.parameters() if p.ndim != 4])]


class Run:
    """Weights, their average, optimizers and record, as a checkpoint holds them."""

    def __init__(self, args, team):
        self.path, self.filters = os.path.join(args.out, "checkpoint.pt"), args.filters
        self.model, self.average = (fresh(args.filters).to(team.device) for _ in range(2))
        self.step, self.maps, self.scenes, self.parts, initial, state = 0, 0.0, 0, [], None, None
        # A recorded step reads the rates from the GPU.
        self.recorded = args.graph
        refuse_graph_without_gpu(args, team.device)
        self.rate, self.lerp = (torch.tensor(float(v), device=team.device) for v in (args.lr, 0.0))
        kept = {"lr": self.rate if self.recorded else args.lr, "capturable": self.recorded}
        if os.path.exists(self.path):
            state = loaded(self.path, team.device, ("model", "average", "optimizers", "step"), "train_thesis.py")
            if state.get("filters", 16) != self.filters:
                raise SystemExit(f"{self.path} is of a network of {state.get('filters', 16)} filters; --filters asks for {self.filters}")
            # A run goes on with the optimizers that it has.
            self.optimizers = optimizers(self.model, len(state["optimizers"]) > 1, **kept)
            fill(self.average, state["average"], self.path)
            for optimizer, saved in zip(self.optimizers, state["optimizers"], strict=True):
                for group in saved["param_groups"]:
                    group.update({name: value for name, value in kept.items() if name in group})  # "capturable" decides on which device steps are counted
                optimizer.load_state_dict(saved)
                for group in optimizer.param_groups:
                    group.update({name: value for name, value in kept.items() if name in group})  # loading copied the groups
            self.step = state["step"]
        else:
            self.optimizers = optimizers(self.model, args.muon, **kept)
            if args.init:
                initial, state = args.init, state_of(args.init)
                fill(self.average, state.get("average", state["model"]), initial, counted=False)
        if state:
            fill(self.model, state["model"], initial or self.path, counted=False)
            self.maps, self.scenes = state.get("maps", 0.0), state.get("scenes", args.first_scene)
            self.parts = json.loads(state.get("parts", "[]"))
        self.part = provenance.Part(initial, self.maps, "Muon" if len(self.optimizers) > 1 else "AdamW")

    def records(self):
        return [*self.parts, self.part.now(self.maps)]

    def prepare(self, rate):
        """Sets the learning rate of the next step, and how far the average moves."""
        self.rate.fill_(rate)
        self.lerp.fill_(1 - min(0.999, (1 + self.step) / (10 + self.step)))
        self.step += 1
        if not self.recorded:
            for group in (group for optimizer in self.optimizers for group in optimizer.param_groups):
                group["lr"] = rate

    @torch.no_grad()
    def advance(self):
        """One step down the gradient that was computed; the average follows, and its batch norms' statistics are the model's."""
        for optimizer in self.optimizers:
            optimizer.step()
        follow(self.average, self.model, self.lerp)
        for a, p in zip(self.average.buffers(), self.model.buffers()):
            a.copy_(p)

    def save(self):
        save(self.path, {"model": self.model.state_dict(), "average": self.average.state_dict(), "optimizers": [o.state_dict() for o in self.optimizers],
                         "filters": self.filters, "step": self.step, "maps": self.maps, "scenes": self.scenes, "parts": json.dumps(self.records())})


class Buffer:
    """This process' newest scenes, and an endless iterator of batches of them."""

    def __init__(self, run, args, team):
        self.data, self.run, self.args, self.team, self.entries = training_scenes(args.experiment), run, args, team, []
        #: Number of the next scene.
        self.drawn = run.scenes

    def __next__(self):
        for _ in range(1 if self.entries else CROPS):
            self.entries.append(self.data[self.drawn + self.team.rank])
            self.drawn += self.team.size
        self.entries = self.entries[-BUFFER:]
        pick = np.random.default_rng([self.args.experiment, self.drawn, self.team.rank])
        is_whole = self.run.step >= self.args.whole_from
        chosen = [self.entries[pick.integers(len(self.entries))] for _ in range(self.args.batch if is_whole else CROPS)]
        return stacked(chosen if is_whole else [crop(entry, pick) for entry in chosen])

    def close(self):
        """Nothing runs beside it."""


def scenes_of(run, args, team):
    """Batches of training scenes, from the first that the run has not drawn on."""
    if args.pool:
        return Pool(training_scenes(args.experiment), run.scenes, args.batch, team.device, args.pool, args.uses, run.scenes)
    return Buffer(run, args, team)


def step_of(run, args, team):
    """One step of training as a function of a batch; it returns the loss."""
    model = team.share(run.model)

    def step(batch):
        with torch.autocast(team.device.type, torch.bfloat16, enabled=args.bf16, cache_enabled=not run.recorded):
            output = model(batch["mag_phase"].contiguous(memory_format=torch.channels_last))[:, 0]
        loss = loss_of(args.experiment, output.float(), batch["truth"])
        run.model.zero_grad(set_to_none=True)
        loss.backward()
        run.advance()
        return loss.detach()

    return Replayed(step) if run.recorded else step


def validate(run, sets, log, args, team):
    report = figures(estimate_with(run.average, team.device), sets)
    line = json.dumps({"step": run.step, "maps": run.maps, "loss": log.smoothed, **report})
    with open(os.path.join(args.out, "validation.jsonl"), "a") as f:
        f.write(line + "\n")
    team.say(line)


def train(run, args, team):
    run.model.train()
    sets = validation_scenes(args.experiment, args.validation, network="thesis") if team.is_first and args.validation else None
    clock = Clock()
    log = Log(args.out, run.step) if team.is_first else None
    step, scenes = step_of(run, args, team), scenes_of(run, args, team)
    saved, validated, losses = 0.0, float("-inf"), []
    while True:
        seconds = team.agreed(clock.seconds())
        done = run.step >= args.steps if args.steps is not None else seconds > 60 * args.minutes
        if team.is_first and (done or seconds - saved >= 60 * args.save_every):
            finite(losses, run, args)
            run.save()
            saved = seconds
        if sets and (done or seconds - validated > 60 * args.validate_every):
            with clock.stopped():
                validate(run, sets, log, args, team)
            validated = seconds
        if done:
            scenes.close()
            return
        batch = {name: t.to(team.device) for name, t in next(scenes).items()}
        rate = args.lr * min((run.step + 1) / WARM_UP, (1 + run.step / 1000) ** -0.5) * cooled(args, seconds)
        run.prepare(rate)
        losses.append(step(batch))
        run.scenes = scenes.drawn
        # A crop counts as a part of a map.
        maps, rows, _ = batch["truth"].shape
        run.maps += maps * rows / ROWS * team.size
        if len(losses) == args.log_every:
            mean = team.mean(finite(losses, run, args))
            losses.clear()
            if log:
                log.line(run.step, run.maps, clock.seconds(), rate, mean)


def main(args):
    torch.manual_seed(args.experiment)
    team = Team(args.threads)
    folder_of(args)
    run = Run(args, team)
    options.refuse_untrained(args, run.maps)
    if args.export:
        sets = validation_scenes(args.experiment, args.validation, network="thesis")
        settle(run.average, args.experiment, team.device)
        report = figures(estimate_with(run.average, team.device), sets)
        small = "" if args.filters == 64 else "-small"
        meta = {"network": "thesis", "recipe": f"experiment-{args.experiment}{small}", "trainer": "training/train_thesis.py (PyTorch)",
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
