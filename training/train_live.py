"""Trains the live network on scenes simulated as it goes: the PyTorch twin of `apertura train live`, which trains several times as fast
on a CPU. The shipped weights come from here.

    python3 train_live.py --out DIR --minutes 80                     # start, or go on from DIR/checkpoint.pt
    python3 train_live.py --out DIR --minutes 80 \\
        --init ../assets/weights/live.safetensors                    # go on from the shipped weights
    python3 train_live.py --out DIR --validation 24 \\
        --export ../assets/weights/live.safetensors                  # write the averaged weights and their figures, and stop
    python3 train_live.py --validation 24 --judge FILE               # figures of any weights on the validation scenes, and stop

Needs torch, numpy and safetensors. The learning rate rises over 200 steps and then falls with the square root of the steps of this run; so a run needs
no end, and a moving average of the weights is what is validated and written. With `--workers` above 1 they take steps on the same weights
without waiting for each other, and a run does not repeat bit for bit. A checkpoint holds weights, their moving average, optimizer, generator
state, the number of scenes drawn and the record of every part of the run, and is replaced in one step. After a resume the scene buffers fill
again with the next scenes of the training stream.

Every scene comes with a noise draw of its own, a third of them over thermal noise from 60 to 10 dB. Training, validation and test scenes come
from generators with different keys; the figures in the README come from `apertura evaluate`, whose test scenes this program never sees.
"""
import json
import os
import time

import options

if __name__ == "__main__":
    ARGUMENTS = options.live()  # before PyTorch, which takes seconds to load

import torch
import torch.multiprocessing as mp

import features as ft
import provenance
import scenes as sc
from common import export, figures, save, unit, validation_scenes
from live import Live, normalise, widened

WARM_UP = 200
#: What the validation figures are given for: the kinds over the thesis' floor, and three sets over thermal noise.
KINDS = tuple(k for k in sc.MIXTURE if k != "field")
NOISY = {"2 at 40 dB": (2, 40), "2 at 20 dB": (2, 20), "3 at 40 dB": (3, 40)}


def make_entry(points, rng, with_mirror=False, snr=None):
    y = sc.simulate(points, rng, snr_db=snr)
    log = sc.log_map(y)
    samples = sc.ends(y)
    out = []
    for flip in (False, True)[: 1 + with_mirror]:
        fine, coarse, rows, scalars, gain = ft.features(ft.mirror(samples) if flip else samples)
        target = (ft.mirror_map(log) if flip else log) - float(gain)
        out.append((fine.half(), coarse.half(), rows.half(), scalars, target.half()))
    return out


def batch_of(entries):
    fine, coarse, rows, scalars, target = (torch.stack(t).float() for t in zip(*entries))
    return (fine, coarse, rows, scalars), target


def validation_sets(seed, count):
    sets = validation_scenes(seed, count, make_entry, KINDS)
    for number, (name, (kind, snr)) in enumerate(NOISY.items(), len(KINDS) + 1):
        sets[name] = []
        for i in range(count):
            rng = sc.rng_for("validation", seed, 10_000 * number + i)
            sets[name] += make_entry(sc.GENERATORS[kind](rng), rng, snr=snr)
    return sets


def loss_of(log, minimum, target, edge_weight):
    truth = unit(target)
    out = normalise(log, minimum)
    weight = 1 + 6 * torch.sigmoid((truth - 0.85) / 0.03)
    loss = (weight * (out - truth) ** 2).mean() * 225
    if edge_weight > 0:
        mask = (truth > 0.9).float()
        loss = loss + edge_weight * torch.nn.functional.binary_cross_entropy_with_logits((out - 0.9) / 0.02, mask)
    return loss


def estimate_with(model):
    """For `common.figures`."""
    def estimate(entries):
        inputs, target = batch_of(entries)
        output = normalise(*model(*inputs)).clamp(0, 1)
        return output, unit(target), output
    return estimate


def optimizer_of(model, args):
    return torch.optim.AdamW(model.parameters(), lr=args.lr, weight_decay=1e-4, betas=(0.9, 0.99))


class Run:
    """Weights, their average, optimizer and record, as a checkpoint holds them."""

    def __init__(self, args):
        self.path = os.path.join(args.out, "checkpoint.pt")
        self.model, self.average = Live().to(memory_format=torch.channels_last), Live()
        self.optimizer = optimizer_of(self.model, args)
        self.pick = torch.Generator().manual_seed(args.seed)
        self.step, self.drawn, self.batch, self.parts, initial = 0, 0, args.batch, [], None
        if os.path.exists(self.path):
            state = torch.load(self.path, weights_only=True)
            self.model.load_state_dict(state["model"])
            self.optimizer.load_state_dict(state["optimizer"])
            self.pick.set_state(state["pick"])
            self.step, self.drawn, self.parts = state["step"], state["drawn"], json.loads(state["parts"])
            self.average.load_state_dict(state["average"])
        else:
            if args.init:
                from safetensors.torch import load_file
                initial = args.init
                self.model.load_state_dict(widened(load_file(initial)))
                self.drawn, self.parts = args.first_scene, provenance.parts_of(initial)
            self.average.load_state_dict(self.model.state_dict())
        #: Maps that the weights saw before the steps of this run.
        self.before = provenance.maps_of(self.parts) - self.step * self.batch
        self.part = provenance.Part(initial, self.seen(), "AdamW")

    def seen(self):
        """Maps that the weights saw, in all parts."""
        return self.before + self.step * self.batch

    def records(self):
        return [*self.parts, self.part.now(self.seen())]

    @torch.no_grad()
    def follow(self):
        decay = min(0.998, (1 + self.step) / (10 + self.step))
        for a, p in zip(self.average.parameters(), self.model.parameters()):
            a.lerp_(p, 1 - decay)

    def save(self):
        save(self.path, {"model": self.model.state_dict(), "average": self.average.state_dict(), "optimizer": self.optimizer.state_dict(),
                         "pick": self.pick.get_state(), "step": self.step, "drawn": self.drawn, "parts": json.dumps(self.records())})


def train(args, model, counter, worker, optimizer, pick, after):
    """One worker: draws scenes, takes steps on the shared weights, without waiting for the others (as Hogwild)."""
    torch.set_num_threads(args.threads)
    buffer, at, running = [], 0, None
    while True:
        for _ in range(args.new_scenes if len(buffer) >= args.batch * 8 else args.batch):
            index = int(counter[1])
            counter[1] += 1
            # one stream a worker: the worker's number is part of the index
            rng = sc.rng_for("train", args.seed, index * 16 + worker)
            snr = rng.uniform(10, 60) if rng.random() < args.snr_share else None
            for entry in make_entry(sc.mixture(rng), rng, True, snr):
                if len(buffer) < args.buffer:
                    buffer.append(entry)
                else:
                    buffer[at % args.buffer] = entry
                at += 1
        chosen = torch.randint(len(buffer), (args.batch,), generator=pick).tolist()
        inputs, target = batch_of([buffer[i] for i in chosen])
        step = int(counter[0])
        for group in optimizer.param_groups:
            group["lr"] = args.lr * min((step + 1) / WARM_UP, (1 + step / 2000) ** -0.5)
        with torch.autocast("cpu", torch.bfloat16, enabled=args.bf16):
            log, minimum = model(*inputs)
        loss = loss_of(log, minimum, target, args.edge_weight)
        if not torch.isfinite(loss):
            raise SystemExit(f"loss is not finite at step {step}; the last good checkpoint is in {args.out}")
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimizer.step()
        counter[0] += 1
        running = loss.item() if running is None else 0.98 * running + 0.02 * loss.item()
        if after is not None and after(running):
            return


def helper(args, model, counter, worker):
    pick = torch.Generator().manual_seed(args.seed + 1000 * worker + int(counter[0]))
    train(args, model, counter, worker, optimizer_of(model, args), pick, None)


def main(args):
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    if args.judge:
        from safetensors.torch import load_file
        model = Live()
        model.load_state_dict(widened(load_file(args.judge)))
        print(json.dumps(figures(estimate_with(model), validation_sets(args.seed, args.validation))))
        return
    os.makedirs(args.out, exist_ok=True)
    run = Run(args)
    options.refuse_untrained(args, run.seen())
    if args.export:
        report = figures(estimate_with(run.average), validation_sets(args.seed, args.validation))
        meta = {"network": "live", "recipe": "live", "trainer": "training/train_live.py (PyTorch)", "seed": str(args.seed),
                "steps": str(run.step), "scenes_simulated": str(run.drawn), **provenance.metadata(run.parts)}
        export(run.average.state_dict(), args.export, meta, report, args.validation)
        return
    run.model.share_memory()
    counter = torch.tensor([run.step, run.drawn], dtype=torch.int64).share_memory_()
    helpers = [mp.Process(target=helper, args=(args, run.model, counter, w), daemon=True) for w in range(1, args.workers)]
    for h in helpers:
        h.start()
    sets = validation_sets(args.seed, args.validation)
    log_path = os.path.join(args.out, "log.jsonl")
    began = time.time()
    clock = {"save": began, "validate": 0.0}

    def after(running):
        run.step, run.drawn = int(counter[0]), int(counter[1])
        run.follow()
        done = time.time() - began > args.minutes * 60
        if time.time() - clock["validate"] > args.validate_every * 60 or done:
            line = {"maps": run.seen(), "drawn": run.drawn, "loss": running, **figures(estimate_with(run.average), sets)}
            with open(log_path, "a") as f:
                f.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)
            clock["validate"] = time.time()
        if time.time() - clock["save"] > 120 or done:
            run.save()
            clock["save"] = time.time()
        return done

    train(args, run.model, counter, 0, run.optimizer, run.pick, after)
    for h in helpers:
        h.terminate()


if __name__ == "__main__":
    main(ARGUMENTS)
