"""What the training programs share: figures on validation scenes, and files that are replaced in one step."""
import contextlib
import os
import time

import numpy as np
import torch

import apertura as ap

#: False-alarm rates at which P_D is given: the thesis' for its own sets.
P_FA = {"1": 0.0037, "2": 0.0056, "3": 0.0102}
ELSEWHERE = 0.01


#: What the networks learn: the map of the array as it should be, over the noise of the scene.
TARGET = "calibrated"
LEARNED = f"target_{TARGET}"


def false_alarm(kind):
    return P_FA.get(kind, ELSEWHERE)


def unit(maps):
    """Every map of a batch stretched from its minimum and maximum to [0, 1]."""
    lo, hi = maps.amin((1, 2), keepdim=True), maps.amax((1, 2), keepdim=True)
    return (maps - lo) / (hi - lo)


def validation_scenes(seed, count, kinds=tuple(P_FA), network="live", others=None):
    """Examples of `count` validation scenes of each of the kinds, in f16, and of each name in `others`, whose values are arguments of `Scenes`."""
    sets = {kind: {"mixture": kind} for kind in kinds} | (others or {})
    half = lambda example: {name: t.half() if t.ndim > 1 and t.dtype == torch.float32 else t for name, t in example.items() if name != "ends"}
    usual = {"seed": seed, "length": count, "purpose": "validation", "network": network, "targets": [TARGET]}
    made = {name: ap.torch.Scenes(**given, **usual) for name, given in sets.items()}
    return {name: [half(scenes[i]) for i in range(count)] for name, scenes in made.items()}


def stacked(entries):
    """Entries as a batch in f32."""
    return {name: torch.stack([entry[name] for entry in entries]).float() for name in entries[0]}


@torch.no_grad()
def figures(estimate, sets):
    """SE, and P_D with its threshold at `false_alarm(kind)`, for each kind; `eta` is where the mean P_FA is the mean of these.

    `estimate` turns a batch into Lambda of output and target, and what is held against a threshold, [n, range bins, columns] each."""
    etas = np.linspace(0.5, 1.0, 251)
    report, alarms = {}, []
    for k, entries in sets.items():
        se, pd, pfa = [], [], []
        for i in range(0, len(entries), 4):
            for output, target, shown in zip(*(t.cpu() for t in estimate(stacked(entries[i : i + 4])))):
                se.append(float(((output - target) ** 2).sum()))
                mask = target > 0.9
                on, off = np.sort(shown[mask].numpy()), np.sort(shown[~mask].numpy())
                pd.append(1 - np.searchsorted(on, etas, "right") / on.size)
                pfa.append(1 - np.searchsorted(off, etas, "right") / off.size)
        pd, pfa = np.mean(pd, 0), np.mean(pfa, 0)
        alarms.append(pfa)
        j = int(np.argmax(pfa <= false_alarm(k)))
        report[k] = {"se": float(np.mean(se)), "pd": float(pd[j]) * 100, "eta": float(etas[j]), "at": false_alarm(k)}
    mean = float(np.mean([false_alarm(k) for k in sets]))
    report["eta"] = float(etas[int(np.argmax(np.mean(alarms, 0) <= mean))])
    return report


class Clock:
    """Seconds since the start, but for those in which it was stopped."""

    def __init__(self):
        self.began = time.monotonic()

    def seconds(self):
        return time.monotonic() - self.began

    @contextlib.contextmanager
    def stopped(self):
        stopped = time.monotonic()
        yield
        self.began += time.monotonic() - stopped


def loaded(path, device, keys, what):
    """A checkpoint of ours that holds these keys; anything else ends the program with a line."""
    try:
        state = torch.load(path, weights_only=True, map_location=device)
    except Exception as error:  # the first sentence of the reader's message says what is wrong with the file
        what = " ".join(str(error).split()).split(". ")[0][:200]
        raise SystemExit(f"{path} is no checkpoint that can be read: {what}; expected a file that a run wrote") from None
    missing = [key for key in keys if not isinstance(state, dict) or key not in state]
    if missing:
        raise SystemExit(f"{path} is no checkpoint of {what}: it has no \"{missing[0]}\"")
    return state


def tensors_of(path):
    """The tensors of a weight file; anything else ends the program with a line."""
    from safetensors.torch import load_file
    try:
        return load_file(path)
    except Exception as error:  # safetensors has an error of its own
        raise SystemExit(f"{path} is no weight file that can be read: {error}; expected safetensors") from None


def fill(module, tensors, path, counted=True):
    """Loads tensors into a module; those of another network end the program with a line. Weight files don't hold how many batches were `counted`."""
    if not counted:
        tensors = {name: t for name, t in module.state_dict().items() if name.endswith("num_batches_tracked")} | tensors
    try:
        module.load_state_dict(tensors)
    except (RuntimeError, KeyError) as error:
        first = [line.strip() for line in str(error).splitlines() if line.strip()][:2]
        raise SystemExit(f"{path} holds weights of another network: {' '.join(first)[:160]}") from None


def cooled(args, seconds):
    """What is left of the learning rate this long after the start: it falls to zero over the last `--cool` minutes."""
    return min(1.0, max(0.0, args.minutes - seconds / 60) / args.cool) if args.cool else 1.0


def finite(losses, run, args):
    """The mean of the last losses; 0 of none. One that is not finite ends the program."""
    mean = torch.stack(losses).mean().item() if losses else 0.0
    if not mean < float("inf"):
        raise SystemExit(f"loss is {mean} at step {run.step}; the last good checkpoint is in {args.out}")
    return mean


def folder_of(args):
    """Makes the run's folder; where that can't be, the program ends with a line."""
    try:
        os.makedirs(args.out, exist_ok=True)
    except OSError as error:
        raise SystemExit(f"--out {args.out}: {error.strerror}") from None


def refuse_graph_without_gpu(args, device):
    if args.graph and device.type != "cuda":
        raise SystemExit("--graph records the step on a GPU, and PyTorch sees none; leave --graph away")


@torch.no_grad()
def follow(average, model, part):
    """Moves the parameters of `average` this part of the way to the model's."""
    averages = list(average.parameters())
    gaps = torch._foreach_sub(list(model.parameters()), averages)
    torch._foreach_mul_(gaps, part)
    torch._foreach_add_(averages, gaps)


def light(state):
    """The state of Adam with its first moment, which it forgets within steps, in 16 bits: an eighth less to keep."""
    kept = {number: {name: t.bfloat16() if name == "exp_avg" else t for name, t in of.items()} for number, of in state["state"].items()}
    return {**state, "state": kept}


def save(path, state):
    torch.save(state, path + ".part")
    os.replace(path + ".part", path)


def export(model_state, path, meta, report, count):
    """Writes weights as safetensors with their record: `meta` and the figures of `report` on `count` scenes a kind."""
    from safetensors.torch import save_file
    meta = {**meta, "eta": f"{report['eta']:.3f}", "validation": f"{count} scenes a set: " + "; ".join(
        f"{'set ' if k[0] in '123' else ''}{k}: SE {v['se']:.0f}, P_D {v['pd']:.2f} % at P_FA {100 * v['at']:.2f} %"
        for k, v in report.items() if k != "eta")}
    for name, value in meta.items():
        print(f"{name}: {value}")
    save_file({k: v.contiguous() for k, v in model_state.items()}, path + ".part", metadata=meta)
    mask = os.umask(0)
    os.umask(mask)
    os.chmod(path + ".part", 0o666 & ~mask)  # safetensors makes files that their owner alone can read
    os.replace(path + ".part", path)
