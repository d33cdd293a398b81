"""Trains the live network on scenes simulated as it goes: the PyTorch twin of `apertura train live`, which trains several times as fast
on a CPU (bfloat16, channels last). The shipped weights come from here.

    python3 train_live.py --out DIR --minutes 80                     # start, or go on from DIR/checkpoint.pt
    python3 train_live.py --out DIR --minutes 80 \\
        --init ../../assets/weights/live.safetensors --lr 5e-4       # go on from the shipped weights
    python3 train_live.py --out DIR --validation 24 \\
        --export ../../assets/weights/live.safetensors               # write the averaged weights and their figures, and stop

Needs torch, numpy and safetensors. The learning rate follows a cosine over `--minutes` of wall-clock time, counted over all
parts of a run. Two workers take steps on the same weights without waiting for each other, so a run does not repeat bit for bit.
A checkpoint holds weights, their moving average, optimizer, generator state and the number of scenes drawn, and is replaced in
one step. After a resume the scene buffers fill again with the next scenes of the training stream.

Training, validation and test scenes come from generators with different keys; the figures in the README come from
`apertura evaluate`, whose test scenes this program never sees.
"""
import argparse
import json
import math
import os
import time

import torch
import torch.multiprocessing as mp

import features as ft
import scenes as sc
from common import export, figures, save, unit, validation_scenes
from live import Live, normalise

def make_entry(points, rng, with_mirror, snr_share=0.0):
    snr = rng.uniform(20, 60) if rng.random() < snr_share else None
    y = sc.simulate(points, rng, snr_db=snr)
    log = sc.log_map(y)
    samples = sc.ends(y)
    out = []
    for flip in (False, True)[: 1 + with_mirror]:
        fine, coarse, rows, scalars, gain = ft.features(ft.mirror(samples) if flip else samples)
        target = (ft.mirror_map(log) if flip else log) - float(gain)
        out.append((fine.half(), coarse.half(), rows.half(), scalars, target.half()))
    return out


def plain_entry(points, rng):
    return make_entry(points, rng, False)


def batch_of(entries):
    fine, coarse, rows, scalars, target = (torch.stack(t).float() for t in zip(*entries))
    return (fine, coarse, rows, scalars), target


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
    """For `common.figures`: Lambda of output and target."""
    def estimate(entries):
        inputs, target = batch_of(entries)
        return normalise(*model(*inputs)).clamp(0, 1), unit(target)
    return estimate


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("--out", required=True)
    ap.add_argument("--minutes", type=float, default=80)
    ap.add_argument("--seed", type=int, default=0)
    ap.add_argument("--batch", type=int, default=4)
    ap.add_argument("--new-scenes", type=int, default=1, help="scenes simulated a step (each enters with its mirror image)")
    ap.add_argument("--buffer", type=int, default=512, help="maps kept a worker")
    ap.add_argument("--workers", type=int, default=2)
    ap.add_argument("--threads", type=int, default=1, help="threads a worker")
    ap.add_argument("--lr", type=float, default=1.5e-3)
    ap.add_argument("--edge-weight", type=float, default=0.0)
    ap.add_argument("--validation", type=int, default=12, help="validation scenes a set")
    ap.add_argument("--validate-every", type=float, default=5, help="minutes")
    ap.add_argument("--snr-share", type=float, default=0.12, help="part of the scenes over thermal noise, 20 to 60 dB SNR")
    ap.add_argument("--export", help="write the averaged weights to this file, with their validation figures, and stop")
    ap.add_argument("--init", help="safetensors file whose matching tensors start the weights")
    args = ap.parse_args()
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    os.makedirs(args.out, exist_ok=True)
    path = os.path.join(args.out, "checkpoint.pt")
    log_path = os.path.join(args.out, "log.jsonl")

    model = Live().to(memory_format=torch.channels_last)
    average = Live()
    average.load_state_dict(model.state_dict())
    optimizer = torch.optim.AdamW(model.parameters(), lr=args.lr, weight_decay=1e-4, betas=(0.9, 0.99))
    pick = torch.Generator().manual_seed(args.seed)
    step, drawn, elapsed, best = 0, 0, 0.0, {}
    if os.path.exists(path):
        state = torch.load(path, weights_only=True)
        model.load_state_dict(state["model"])
        average.load_state_dict(state["average"])
        optimizer.load_state_dict(state["optimizer"])
        pick.set_state(state["pick"])
        step, drawn, elapsed, best = state["step"], state["drawn"], state["elapsed"], state["report"]
    elif args.init:
        from safetensors.torch import load_file
        old = load_file(args.init)
        own = model.state_dict()
        fit = {k: v for k, v in old.items() if k in own and own[k].shape == v.shape}
        print(f"initial weights: {len(fit)} of {len(own)} tensors from {args.init}", flush=True)
        model.load_state_dict({**own, **fit})
        average.load_state_dict(model.state_dict())
    if args.export:
        report = figures(estimate_with(average), validation_scenes(args.seed, args.validation, plain_entry))
        meta = {"network": "live", "recipe": "live", "trainer": "benches/twin/train_live.py (PyTorch)", "seed": str(args.seed),
                "steps": str(step), "scenes_simulated": str(drawn), "maps_seen": str(step * args.batch),
                "minutes": f"{elapsed / 60:.0f}"}
        export(average.state_dict(), args.export, meta, report, args.validation)
        return
    model.share_memory()
    counter = torch.tensor([step, drawn], dtype=torch.int64).share_memory_()
    began = time.time() - elapsed
    helpers = [mp.Process(target=train, args=(args, model, counter, began, w), daemon=True) for w in range(1, args.workers)]
    for h in helpers:
        h.start()

    sets = validation_scenes(args.seed, args.validation, plain_entry)
    clock = {"save": time.time(), "validate": time.time(), "report": best}

    def after(step, drawn, running, elapsed, optimizer, pick):
        decay = min(0.998, (1 + step) / (10 + step))
        with torch.no_grad():
            for a, p in zip(average.parameters(), model.parameters()):
                a.lerp_(p, 1 - decay)
        done = elapsed > args.minutes * 60
        if time.time() - clock["validate"] > args.validate_every * 60 or done:
            clock["report"] = figures(estimate_with(average), sets)
            clock["validate"] = time.time()
            with open(log_path, "a") as f:
                line = {"step": step, "drawn": drawn, "elapsed": elapsed, "loss": running, **clock["report"]}
                f.write(json.dumps(line) + "\n")
            print("validation", json.dumps(clock["report"]), flush=True)
        if time.time() - clock["save"] > 120 or done:
            save(path, {"model": model.state_dict(), "average": average.state_dict(), "optimizer": optimizer.state_dict(),
                        "pick": pick.get_state(), "step": step, "drawn": drawn, "elapsed": elapsed,
                        "report": clock["report"]})
            clock["save"] = time.time()

    train(args, model, counter, began, 0, optimizer, pick, after)
    for h in helpers:
        h.terminate()


def train(args, model, counter, began, worker, optimizer=None, pick=None, after=None):
    """One worker: draws scenes, takes steps on the shared weights, without waiting for the others (as Hogwild)."""
    torch.set_num_threads(args.threads)
    optimizer = optimizer or torch.optim.AdamW(model.parameters(), lr=args.lr, weight_decay=1e-4, betas=(0.9, 0.99))
    pick = pick or torch.Generator().manual_seed(args.seed + 1000 * worker + int(counter[0]))
    buffer, at = [], 0
    total = args.minutes * 60
    running = None
    elapsed = 0.0
    while elapsed < total:
        for _ in range(args.new_scenes if len(buffer) >= args.batch * 8 else args.batch):
            index = int(counter[1])
            counter[1] += 1
            # one stream a worker: the worker's number is part of the index
            rng = sc.rng_for("train", args.seed, index * 16 + worker)
            for entry in make_entry(sc.mixture(rng), rng, True, args.snr_share):
                if len(buffer) < args.buffer:
                    buffer.append(entry)
                else:
                    buffer[at % args.buffer] = entry
                at += 1
        chosen = torch.randint(len(buffer), (args.batch,), generator=pick).tolist()
        inputs, target = batch_of([buffer[i] for i in chosen])
        elapsed = time.time() - began
        step = int(counter[0])
        lr = args.lr * min(1, (step + 1) / 200) * max(0.01, 0.5 * (1 + math.cos(math.pi * min(1, elapsed / total))))
        for group in optimizer.param_groups:
            group["lr"] = lr
        with torch.autocast("cpu", torch.bfloat16):
            log, minimum = model(*inputs)
        loss = loss_of(log, minimum, target, args.edge_weight)
        if not torch.isfinite(loss):
            raise SystemExit(f"loss is not finite at step {step}; the last good checkpoint is in {args.out}")
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimizer.step()
        counter[0] += 1
        value = float(loss.detach())
        running = value if running is None else 0.98 * running + 0.02 * value
        if after is not None:
            after(int(counter[0]), int(counter[1]), running, elapsed, optimizer, pick)
            if (step // 50) != (int(counter[0]) // 50):
                print(f"step {step} scenes {int(counter[1])} lr {lr:.2e} loss {running:.4f} {elapsed / 60:.1f} min", flush=True)


if __name__ == "__main__":
    main()
