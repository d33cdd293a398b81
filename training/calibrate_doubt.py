"""Fits the term of the live network's doubt that is the same for every cell of a scene, so that 90 % of the cells have at most their doubt's error.

    python3 calibrate_doubt.py FILE                  # fit on the validation scenes of seed 0, write into FILE, print the coverage on those of seed 1
    python3 calibrate_doubt.py FILE --judge          # print the coverage alone

The term is linear in the means of the head's hidden layer. Its weights minimise a sum: the pinball loss of all cells, the squared distance of each kind's
coverage from 90 %, and the squares of the weights. Nothing else in FILE changes. The scenes are those of every kind over the thesis'
floor, of every kind over thermal noise of 10 to 60 dB, and of two sets heard by elements that are off; training and test never see them.
Weights for radars within limits see four kinds before each of the radars of `train_live.py` that they are for, over the same floors. Weights for one other radar
see every kind that has room before it.

Needs what train_live.py needs. 32 scenes a kind take 10 minutes on two cores.
"""
import argparse
import json
import os

import numpy as np
import torch
from safetensors import safe_open
from safetensors.torch import save_file

import apertura as ap
from apertura.live import CELL_DECADES, DOUBT, SCENE_DECADES, SIZE, WINDOWS, Doubt, Live, normalise, parted, trained_radar, widened, widened_cells
from common import LEARNED, TARGET, fill, tensors_of
from train_live import COVERED, INPUTS, KINDS, OFF, RADARS, error_of, has_room

#: Cells of a scene that the fit sees, drawn at random.
CELLS = 4096
#: Weight of the kinds' coverage beside the pinball loss, and of the layer's own size.
OF_KINDS, OF_SIZE = 3.0, 1e-3
#: Steps of Adam, and over how many decades a cell counts as half covered.
STEPS, SOFT = 300, 0.05
#: Errors below this are the same.
LEAST = 1e-7


#: Kinds of scenes before each of `RADARS`.
KINDS_OF_RADARS = ("2", "3", "clusters", "walls")


def groups(domain):
    """Of each kind of scene, by name, the arguments of `Scenes`; `domain` is that of the weights, empty for table 3.1's radar."""
    trained = trained_radar(domain)
    radar = {} if trained is None else {"radar": trained}
    off = {name: {**given, **radar} for name, given in OFF.items()}
    found = {kind: {"mixture": kind, **radar} for kind in KINDS if trained is None or has_room(kind, trained)}
    limits = domain.get("limits")
    if limits is not None:
        windows = limits.get("windows") or list(WINDOWS)
        radars = {name: ap.Radar(**given) for name, given in RADARS.items() if given.get("window", "hann") in windows}
        found = {f"{kind}, {name}": {"mixture": kind, "radar": radar} for name, radar in radars.items() for kind in KINDS_OF_RADARS}
    found |= {f"{name} at 10 to 60 dB": {**given, "thermal": (1.0, 10.0, 60.0)} for name, given in found.items()}
    return found if limits is not None else found | off


@torch.no_grad()
def seen(live, doubt, seed, count, domain):
    """For each kind of scene: the hidden layer's means, [count, hidden], and log10 of error over said error of some cells, [count, CELLS]."""
    draw = np.random.default_rng(seed)
    found = {}
    for name, given in groups(domain).items():
        data = ap.torch.Scenes(**given, seed=seed, length=count, purpose="validation", targets=[TARGET], network="live")
        means, gaps = [], []
        for i in range(count):
            example = data[i]
            log, minimum, picture = live.with_picture(*(example[name][None] for name in INPUTS))
            of_cells, hidden = doubt.parts(picture)
            error = error_of(normalise(log, minimum), example[LEARNED][None])
            gap = torch.log10(error + LEAST) - widened_cells(of_cells.clamp(*CELL_DECADES), live.columns)
            means.append(hidden[0])
            gaps.append(gap.flatten()[torch.from_numpy(draw.choice(gap.numel(), CELLS, replace=False))])
        found[name] = torch.stack(means).double(), torch.stack(gaps).double()
        print(f"{name}: seen", flush=True)
    return found


def fitted(found):
    """Weights [hidden] and constant of the scene's term."""
    means, gaps = (torch.cat(parts) for parts in zip(*found.values()))
    centre, spread = means.mean(0), means.std(0) + 1e-9
    known = (means - centre) / spread
    weights, constant = torch.zeros(means.shape[1], dtype=torch.float64, requires_grad=True), torch.zeros(1, dtype=torch.float64, requires_grad=True)
    optimizer = torch.optim.Adam([weights, constant], lr=0.02)
    rates = torch.optim.lr_scheduler.MultiStepLR(optimizer, [2 * STEPS // 3], gamma=0.2)
    for _ in range(STEPS):
        beyond = gaps - (known @ weights + constant)[:, None]
        pinball = torch.maximum(COVERED * beyond, (COVERED - 1) * beyond).mean()
        kinds = torch.sigmoid(-beyond / SOFT).reshape(len(found), -1).mean(1)
        loss = pinball + OF_KINDS * ((kinds - COVERED) ** 2).mean() + OF_SIZE * (weights**2).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        rates.step()
    weights, constant = weights.detach() / spread, constant.detach()
    return weights, constant - weights @ centre


def report(found, scene):
    """Prints the coverage of each kind in percent, with its standard error over scenes, without the scene's term and with it."""
    print("covered, percent: without the scene's term, with it")
    within = 0
    for name, (means, gaps) in found.items():
        figures = []
        for of_scene in (torch.zeros(len(means)), scene(means).clamp(-SCENE_DECADES, SCENE_DECADES)):
            covered = 100 * (gaps <= of_scene[:, None]).double().mean(1)
            figures.append((float(covered.mean()), float(covered.std()) / len(covered) ** 0.5))
        within += 88 <= figures[1][0] <= 92
        print(f"{name}: " + ", ".join(f"{mean:.1f} +- {error:.1f}" for mean, error in figures))
    print(f"{within} of {len(found)} kinds within 88 to 92 %")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("file", metavar="FILE", help="weight file of the live network")
    parser.add_argument("--scenes", type=int, default=32, help="validation scenes of each kind")
    parser.add_argument("--judge", action="store_true", help="print the coverage on the scenes of seed 1, and stop")
    args = parser.parse_args()
    tensors = tensors_of(args.file)
    with safe_open(args.file, "pt") as file:
        meta = file.metadata()
    network, of_doubt = parted(tensors)
    if not of_doubt:
        parser.error(f"{args.file} has no head of doubt; expected weights that train_live.py wrote")
    domain = json.loads(meta.get("domain", "{}"))
    live = Live(**json.loads(meta.get(SIZE, "{}")))
    doubt = Doubt(live.stem.conv.out_channels)
    fill(live, widened(network), args.file)
    doubt.load_state_dict(of_doubt, strict=False)
    if not args.judge:
        weights, constant = fitted(seen(live, doubt, 0, args.scenes, domain))
        with torch.no_grad():
            doubt.scene.weight[0], doubt.scene.bias[:] = weights, constant
        changed = {f"{DOUBT}scene.{name}": t.detach() for name, t in doubt.scene.named_parameters()}
        save_file({**tensors, **changed}, args.file + ".part",
                  metadata={**meta, "doubt": f"its scene's part fitted to {args.scenes} validation scenes of each kind, seed 0"})
        os.replace(args.file + ".part", args.file)
    with torch.no_grad():
        report(seen(live, doubt, 1, args.scenes, domain), lambda means: doubt.scene(means.float())[:, 0].double())


if __name__ == "__main__":
    main()
