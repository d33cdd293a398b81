"""Trains the live network on scenes simulated as it goes: the shipped weights come from here.

    python3 train_live.py --out DIR --minutes 80                     # start, or go on from DIR/checkpoint.pt
    torchrun --nproc-per-node 2 --max-restarts 3 \\
        train_live.py --out DIR --minutes 80                         # the same in two processes
    python3 train_live.py --out DIR --minutes 80 \\
        --init ../assets/weights/live.safetensors                    # go on from the shipped weights
    python3 train_live.py --out DIR --validation 24 \\
        --export ../assets/weights/live.safetensors                  # write the averaged weights and their figures, and stop
    python3 calibrate_doubt.py ../assets/weights/live.safetensors    # then fit its doubt to validation scenes
    python3 train_live.py --validation 24 --judge FILE               # figures of any weights on the validation scenes, and stop
    python3 train_live.py --out DIR --minutes 11 --cool 5 --validation 0 --bf16 --batch 32 --graph --lr 1.2e-3 --pool 20000 --uses 8 \\
        --log-every 20 --threads 4 --init ../assets/weights/live.safetensors    # on a GPU that there is for twelve minutes

Needs torch, numpy, safetensors and apertura (`pip install ../python`), which makes the scenes: `apertura.torch.Scenes`. Every scene is new; with `--pool`
each is drawn `--uses` times. They are those of `--mixture`, before one radar drawn for each, that of table 3.1, or that of a file (`--radar`). A radar of another shape gets a network of its shape,
which `apertura.live.Estimator` makes a method of. Half of them lie over
thermal noise (`--snr-share`, `--snr`), a fifth are heard by elements that are off. Example `i` is a function of the seed and `i` alone: a run that goes on takes the next ones, in
any number of processes.

The learning rate rises over 200 steps and then falls with the square root of the steps of this run; so a run needs no end. With `--cool M` it falls to
zero over the last M minutes. Minutes of validation don't count. A moving average of the weights is what is validated and written. Several processes average their gradients, so that a step sees `--batch` scenes of each. A checkpoint holds
weights, their moving average, optimizer, the number of scenes drawn and the record of every part of the run, and is replaced in one step. When a process
is killed, torchrun starts all of them again from it.

Training, validation and test scenes come from streams that never meet; the figures in the README come from `apertura evaluate`, whose test scenes
this program never sees.
"""
import json
import os

import options

if __name__ == "__main__":
    ARGUMENTS = options.live()  # before PyTorch, which takes seconds to load

import torch

import apertura as ap
import provenance
from common import (LEARNED, TARGET, Clock, cooled, export, figures, fill, finite, folder_of, follow, light, loaded, refuse_graph_without_gpu, save, tensors_of,
                    unit, validation_scenes)
from graph import Replayed
from apertura.live import DOUBT, WINDOWS, WINDOWS_AT, Doubt, Doubting, Live, expected_error, normalise, parted, size_of, widened, widened_cells
from pool import Pool
from team import Log, Team, batches

WARM_UP = 200
#: Share of the scenes whose elements are off, and the largest tolerances: gain in decibels, phase in degrees, place in millimetres.
ELEMENTS = (0.2, 1.0, 20.0, 0.1)
#: What the validation figures are given for: these kinds over the thesis' floor before the radar of table 3.1.
KINDS = ("1", "2", "3", "clusters", "walls", "spacings", "corner", "crowd", "dynamic", "near", "bodies", "street", "rails", "occlusion", "rough",
         "fences", "rain", "world")
#: Two sets heard by elements that are off.
OFF = {f"{kind} elements off": {"mixture": kind, "elements": (1.0, 0.6, 6.0, 0.0)} for kind in ("2", "3")}
#: And three sets over thermal noise.
OTHERS = {f"{kind} at {snr} dB": {"mixture": kind, "floor": f"snr={snr}"} for kind, snr in (("2", 40), ("2", 20), ("3", 40))} | OFF
#: Other radars, where weights are for them: name, arguments of `Radar`.
RADARS = {
    "76 GHz": {"carrier_hz": 76e9, "convention": "thesis"}, "1 GHz wide": {"bandwidth_hz": 1e9}, "4 GHz wide": {"bandwidth_hz": 4e9},
    "24 GHz, 250 MHz wide": {"carrier_hz": 24e9, "bandwidth_hz": 250e6, "convention": "thesis"}, "physical": {"convention": "physical"},
    "physical 60 GHz": {"carrier_hz": 60e9, "convention": "physical"}, "rectangular": {"window": "rectangular"},
}
INPUTS = ("fine", "coarse", "rows", "scalars", "constants")


def radar_of(args):
    """What sees the scenes, as `Scenes` takes it."""
    if args.radar in ("random", "thesis"):
        return "random" if args.radar == "random" else None
    try:
        return ap.Radar.load(args.radar)
    except (ValueError, OSError) as error:
        raise SystemExit(f"--radar {error}") from None


def size_for(args):
    """How large the network is: arguments of `Live`."""
    radar = radar_of(args)
    try:
        size = size_of(radar) if isinstance(radar, ap.Radar) else {}
    except ValueError as error:
        raise SystemExit(f"--radar {args.radar}: {error}") from None
    return {**size, "c": (4, 6, 8, 10), "blocks": (1, 1, 1, 1), "fine": 4} if args.tiny else size


def training_scenes(args):
    given = {"thermal": (args.snr_share, *args.snr), "elements": ELEMENTS, "radar": radar_of(args), "targets": [TARGET], "network": "live"}
    try:
        return ap.torch.Scenes(args.mixture, args.seed, length=1 << 32, **given)
    except ValueError as error:
        raise SystemExit(f"--mixture, --snr-share, --snr or --radar: {error}") from None


def whole(network, path):
    """Tensors of a weight file with what earlier editions lack."""
    if "stem.conv.weight" not in network:
        raise SystemExit(f"{path} holds weights of another network: it has no tensor \"stem.conv.weight\"")
    return widened(network)


def validation_sets(args):
    radar = radar_of(args)
    if isinstance(radar, ap.Radar):
        kinds = [kind for kind in KINDS if has_room(kind, radar)]
        others = {name: {**given, "radar": radar} for name, given in OTHERS.items()}
        return validation_scenes(args.seed, args.validation, (), others={kind: {"mixture": kind, "radar": radar} for kind in kinds} | others)
    others = dict(OTHERS)
    if radar == "random":
        others["world, random radars"] = {"mixture": "world", "radar": "random"}
        others |= {f"{kind}, {name}": {"mixture": kind, "radar": ap.Radar(**given)} for name, given in RADARS.items() for kind in ("2", "3")}
    return validation_scenes(args.seed, args.validation, KINDS, others=others)


def has_room(kind, radar):
    """Whether the objects of a kind find room before a radar."""
    try:
        ap.Scene.random(kind, radar=radar, purpose="validation")
    except ValueError:
        return False
    return True


def loss_of(log, minimum, target, edge_weight):
    truth = unit(target)
    out = normalise(log, minimum)
    weight = 1 + 6 * torch.sigmoid((truth - 0.85) / 0.03)
    loss = (weight * (out - truth) ** 2).mean() * 225
    if edge_weight > 0:
        mask = (truth > 0.9).float()
        loss = loss + edge_weight * torch.nn.functional.binary_cross_entropy_with_logits((out - 0.9) / 0.02, mask)
    return loss


#: Part of the cells whose error stays below what `Doubt` says.
COVERED = 0.9
#: Errors of Lambda below this are the same to it.
LEAST_ERROR = 1e-4


def error_of(output, target):
    """Distance of Lambda from the truth, cell by cell."""
    return (output.clamp(0, 1) - unit(target)).abs()


def doubt_loss_of(doubt, error):
    """Pinball loss of the logarithm: least where a part `COVERED` of the errors lies below."""
    gap = torch.log10(error + LEAST_ERROR) - widened_cells(doubt, error.shape[2])
    return torch.maximum(COVERED * gap, (COVERED - 1) * gap).mean()


@torch.no_grad()
def coverage(model, doubt, sets, device="cpu"):
    """Percent of the cells whose error is at most what the network says, by kind."""
    report = {}
    for kind, entries in sets.items():
        covered = []
        for entry in entries:
            batch = {name: t[None].float().to(device) for name, t in entry.items()}
            log, minimum, picture = model.with_picture(*(batch[name] for name in INPUTS))
            of_cells, hidden = doubt.parts(picture)
            limit = expected_error(of_cells, doubt.scene(hidden)[:, 0], model.columns)
            covered.append(float((error_of(normalise(log, minimum), batch[LEARNED]) <= limit).float().mean()))
        report[kind] = round(100 * sum(covered) / len(covered), 2)
    return report


def estimate_with(model, device="cpu"):
    """For `common.figures`."""
    def estimate(batch):
        batch = {name: t.to(device) for name, t in batch.items()}
        output = normalise(*model(*(batch[name] for name in INPUTS))).clamp(0, 1)
        return output, unit(batch[LEARNED]), output
    return estimate


class Run:
    """Weights, their average, optimizer and record, as a checkpoint holds them."""

    def __init__(self, args, team):
        self.path = os.path.join(args.out, "checkpoint.pt")
        #: How large the network is, as `Live` takes it.
        self.size = size_for(args)
        self.model, self.average = (Live(**self.size).to(team.device) for _ in range(2))
        self.model.to(memory_format=torch.channels_last)
        self.doubt = Doubt(self.model.stem.conv.out_channels).to(team.device)
        # A recorded step reads the rates from the GPU.
        self.recorded = args.graph
        refuse_graph_without_gpu(args, team.device)
        self.rate, self.lerp = (torch.tensor(float(v), device=team.device) for v in (args.lr, 0.0))
        kept = {"lr": self.rate if self.recorded else args.lr, "capturable": self.recorded}
        self.optimizer = torch.optim.AdamW([*self.model.parameters(), *self.doubt.parameters()], weight_decay=1e-4, betas=(0.9, 0.99), **kept)
        self.step, self.drawn, self.parts, initial = 0, 0, [], None
        self.seed = args.seed
        #: The radars that the last part trained for.
        self.domain = domain_of(args)
        maps = None
        if os.path.exists(self.path):
            keys = ("model", "doubt", "average", "optimizer", "step", "drawn", "parts")
            state = loaded(self.path, team.device, keys, "train_live.py")
            if state.get("size", "{}") != json.dumps(self.size):
                raise SystemExit(f"{self.path} is of a network of size {state.get('size', '{}')}; --radar and --tiny ask for {json.dumps(self.size)}")
            self.refuse_another(args, state)
            fill(self.model, state["model"], self.path)
            fill(self.doubt, state["doubt"], self.path)
            for group in state["optimizer"]["param_groups"]:
                group.update(kept)  # "capturable" decides on which device steps are counted
            self.optimizer.load_state_dict(state["optimizer"])
            for group in self.optimizer.param_groups:
                group.update(kept)  # loading copied the groups
            self.step, self.drawn, self.parts, maps = state["step"], state["drawn"], json.loads(state["parts"]), state.get("maps")
            self.average.load_state_dict(state["average"])
            if args.export:
                self.domain, self.seed = state.get("domain", self.domain), state.get("seed", self.seed)
        else:
            if args.init:
                initial = args.init
                network, doubt = parted(tensors_of(initial))
                fill(self.model, whole(network, initial), initial)
                if doubt:
                    fill(self.doubt, doubt, initial)
                self.drawn, self.parts = args.first_scene, provenance.parts_of(initial)
            self.average.load_state_dict(self.model.state_dict())
        #: Maps that the weights saw, in all parts.
        self.maps = provenance.maps_of(self.parts) if maps is None else maps
        self.part = provenance.Part(initial, self.maps, "AdamW")

    def refuse_another(self, args, state):
        """Ends the program where the folder holds a run for other radars or of another seed; of an export the checkpoint says both."""
        asked = {"domain": self.domain, "seed": args.seed}
        for name, value in asked.items():
            if state.get(name, value) != value and not args.export:
                option = {"domain": "--radar or --windows ask for the radars", "seed": "--seed is"}[name]
                raise SystemExit(f"{self.path} is of a run of {name} {state[name]}; {option} {value}. Another folder with --init goes on from its weights")

    def records(self):
        return [*self.parts, self.part.now(self.maps)]

    def prepare(self, rate):
        """Sets the learning rate of the next step, and how far the average moves."""
        self.step += 1
        self.rate.fill_(rate)
        self.lerp.fill_(1 - min(0.998, self.step / (9 + self.step)))
        if not self.recorded:
            for group in self.optimizer.param_groups:
                group["lr"] = rate

    def advance(self):
        """One step down the gradient that was computed."""
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), 1.0)
        torch.nn.utils.clip_grad_norm_(self.doubt.parameters(), 1.0)
        self.optimizer.step()
        follow(self.average, self.model, self.lerp)

    def save(self):
        save(self.path, {"model": self.model.state_dict(), "doubt": self.doubt.state_dict(), "average": self.average.state_dict(),
                         "optimizer": light(self.optimizer.state_dict()),
                         "step": self.step, "seed": self.seed, "size": json.dumps(self.size), "domain": self.domain, "drawn": self.drawn, "maps": self.maps, "parts": json.dumps(self.records())})


def has_window(names):
    """Whether the radar of an example has one of these windows, as a function of the example."""
    of = dict(zip(WINDOWS, torch.cat([torch.zeros(1, len(WINDOWS) - 1), torch.eye(len(WINDOWS) - 1)])))
    unknown = [name for name in names if name not in of]
    if unknown:
        raise SystemExit(f"--windows {unknown[0]} is no window; expected {', '.join(of)}")
    return lambda example: any(torch.equal(example["constants"][WINDOWS_AT : WINDOWS_AT + len(WINDOWS) - 1], of[name]) for name in names)


def domain_of(args):
    """The radars that the run trains for, as JSON."""
    domain = json.loads(training_scenes(args).domain)
    if args.windows:
        domain["limits"]["windows"] = args.windows.split(",")
    return json.dumps(domain)


def scenes_of(args, first, team):
    """Batches of training scenes from number `first` on."""
    if args.pool:
        wanted = has_window(args.windows.split(",")) if args.windows else None
        return Pool(training_scenes(args), first, args.batch, team.device, args.pool, args.uses, first, wanted)
    return batches(training_scenes(args), first, args.batch, team, args.loaders)


def step_of(run, args, team):
    """One step of training as a function of a batch; it returns the loss."""
    model = team.share(Doubting(run.model, run.doubt))

    def step(batch):
        with torch.autocast(team.device.type, torch.bfloat16, enabled=args.bf16, cache_enabled=not run.recorded):
            output, minimum, doubt = model(*(batch[name] for name in INPUTS))
        loss = loss_of(output, minimum, batch[LEARNED], args.edge_weight)
        of_doubt = doubt_loss_of(doubt, error_of(normalise(output, minimum), batch[LEARNED]).detach())
        run.optimizer.zero_grad(set_to_none=True)
        (loss + of_doubt).backward()
        run.advance()
        return loss.detach()

    return Replayed(step) if run.recorded else step


def validate(run, sets, log, args, team):
    report = figures(estimate_with(run.average, team.device), sets)
    report["covered"] = coverage(run.average, run.doubt, sets, team.device)
    line = json.dumps({"step": run.step, "maps": run.maps, "loss": log.smoothed, **report})
    with open(os.path.join(args.out, "validation.jsonl"), "a") as f:
        f.write(line + "\n")
    team.say(line)


def train(run, args, team):
    sets = validation_sets(args) if team.is_first and args.validation else None
    clock = Clock()
    log = Log(args.out, run.step) if team.is_first else None
    step = step_of(run, args, team)
    scenes = scenes_of(args, run.drawn, team)
    saved, validated, losses = 0.0, float("-inf"), []
    while True:
        # All processes use the first one's clock: their rates must be the same.
        seconds = team.agreed(clock.seconds())
        done = run.step >= args.steps if args.steps is not None else seconds > 60 * args.minutes
        if team.is_first:
            if done or seconds - saved >= 60 * args.save_every:
                finite(losses, run, args)
                run.save()
                saved = seconds
            if sets and (done or seconds - validated > 60 * args.validate_every):
                with clock.stopped():
                    validate(run, sets, log, args, team)
                validated = seconds
        if done:
            if args.pool:
                scenes.close()
            return
        batch = {name: t.to(team.device) for name, t in next(scenes).items() if name != "ends"}
        rate = args.lr * min((run.step + 1) / WARM_UP, (1 + run.step / 2000) ** -0.5) * cooled(args, seconds)
        run.prepare(rate)
        losses.append(step(batch))
        run.drawn = scenes.drawn if args.pool else run.drawn + args.batch * team.size
        run.maps += args.batch * team.size
        # Reading a loss waits for the GPU.
        if len(losses) == args.log_every:
            mean = team.mean(finite(losses, run, args))
            losses.clear()
            if log:
                log.line(run.step, run.maps, clock.seconds(), rate, mean)


def main(args):
    torch.manual_seed(args.seed)
    team = Team(args.threads)
    if args.judge:
        model = Live(**size_for(args))
        network, of_doubt = parted(tensors_of(args.judge))
        fill(model, whole(network, args.judge), args.judge)
        sets = validation_sets(args)
        report = figures(estimate_with(model), sets)
        if of_doubt:
            doubt = Doubt(model.stem.conv.out_channels)
            fill(doubt, of_doubt, args.judge)
            report["covered"] = coverage(model, doubt, sets)
        print(json.dumps(report))
        return
    folder_of(args)
    run = Run(args, team)
    options.refuse_untrained(args, run.maps)
    if args.export:
        sets = validation_sets(args)
        # Weights are written as 16-bit floats, half the bytes for a page to load; the figures are those of the written weights.
        for tensor in (*run.average.state_dict().values(), *run.doubt.state_dict().values()):
            tensor.copy_(tensor.half())
        report = figures(estimate_with(run.average, team.device), sets)
        meta = {"network": "live", "recipe": "live", "trainer": "training/train_live.py (PyTorch)", "seed": str(run.seed),
                "steps": str(run.step), "scenes_simulated": str(run.drawn), "domain": run.domain, **provenance.metadata(run.parts)}
        if run.size:
            meta["size"] = json.dumps(run.size)
        doubt = {f"{DOUBT}{name}": weights for name, weights in run.doubt.state_dict().items()}
        tensors = {**run.average.state_dict(), **doubt}
        export({name: tensor.half() for name, tensor in tensors.items()}, args.export, meta, report, args.validation)
        return
    if team.restarts:
        team.say(f"restart {team.restarts} of {team.size} processes: going on from step {run.step} of {run.path}")
    train(run, args, team)
    team.end()


if __name__ == "__main__":
    main(ARGUMENTS)
