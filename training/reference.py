"""Writes the references that the tests of `src/network` compare with the Rust side: a tiny live network with random weights,
its input for a small scene, and what this twin makes of it. Usage: python3 reference.py ../tests/data

The input is the package's own. That in ../tests/data was computed by a second program in NumPy, which gave the same numbers.
"""
import json
import sys

import numpy as np
import torch
from safetensors.torch import save_file

import apertura as ap
from apertura.live import Doubt, Estimator, Live, expected_error
from thesis import Thesis

POINTS = np.array([[3.0, 12.0], [-9.5, 17.0], [20.0, 6.0]])


def main(folder):
    torch.manual_seed(7)
    model = Live((4, 6, 8, 10), (1, 1, 1, 1), 4)
    with torch.no_grad():
        for p in model.parameters():
            if p.dim() > 1:
                p.add_(0.05 * torch.randn_like(p))
    doubt = Doubt(4, 5)
    with torch.no_grad():
        doubt.conv2.weight.mul_(20)
        doubt.scene.weight[0, ::2] = 0.3
        doubt.scene.bias.fill_(-0.2)
    given = ap.live_input(ap.Scene.of_points(POINTS).simulate(floor="exact").ends)
    fine, coarse, rows, scalars, constants = (torch.from_numpy(given[name]) for name in ("fine", "coarse", "rows", "scalars", "constants"))
    with torch.no_grad():
        log, minimum, picture = model.with_picture(fine[None], coarse[None], rows[None], scalars[None], constants[None])
        of_cells, hidden = doubt.parts(picture)
        # Constants of a rectangular window, another spacing and migration, and a pattern.
        other = torch.tensor([0.2, -0.1, 0, 0, 1, 1.5])
        other_log, other_minimum, _ = model.with_picture(fine[None], coarse[None], rows[None], scalars[None], other[None])
        of_scene = doubt.scene(hidden)[:, 0]
        assert 0.01 < abs(of_scene) < 0.5, f"{of_scene} decades of the scene say little of the twin"
    weights = {k: v.contiguous() for k, v in model.state_dict().items()}
    save_file(weights, f"{folder}/live_reference_weights.safetensors", metadata={"network": "live"})
    weights.update({f"doubt.{k}": v.contiguous() for k, v in doubt.state_dict().items()})
    save_file(weights, f"{folder}/doubt_reference_weights.safetensors", metadata={"network": "live"})
    tensors = {
        "fine": fine[:, ::32, ::8].contiguous(), "coarse": coarse[:, ::32, ::4].contiguous(), "rows": rows[:, ::8].contiguous(),
        "scalars": scalars, "gain": torch.tensor([given["gain"]]), "log": log[0, ::32, ::16].contiguous(), "minimum": minimum,
        "doubt": expected_error(of_cells, of_scene)[0, ::16, ::16].contiguous(),
        "constants": other, "other_log": other_log[0, ::32, ::16].contiguous(), "other_minimum": other_minimum,
        "points": torch.from_numpy(POINTS).float(),
    }
    save_file(tensors, f"{folder}/live_reference.safetensors", metadata={"network": "live-reference"})


#: A radar of another shape, whose columns fall, and points before it.
SHAPE = {"elements": 86, "end_elements": 8, "samples": 72, "convention": "physical"}
NEAR = np.array([[0.8, 2.5], [-1.5, 3.2], [2.2, 1.4]])


def shape(folder):
    """A tiny network of another shape, in 16-bit floats, and what the method of its file answers."""
    torch.manual_seed(11)
    radar = ap.Radar(**SHAPE)
    size = {"c": (4, 6, 8, 10), "blocks": (1, 1, 1, 1), "fine": 4, "rows": radar.samples, "columns": radar.elements}
    model, doubt = Live(**size), Doubt(4, 5)
    with torch.no_grad():
        for p in model.parameters():
            if p.dim() > 1:
                p.add_(0.05 * torch.randn_like(p))
        doubt.conv2.weight.mul_(20)
    weights = model.state_dict() | {f"doubt.{k}": v for k, v in doubt.state_dict().items()}
    weights = {k: v.half().contiguous() for k, v in weights.items()}
    path = f"{folder}/shape_reference_weights.safetensors"
    domain = ap.torch.Scenes("1", radar=radar, network="live").domain
    save_file(weights, path, metadata={"network": "live", "size": json.dumps(size), "domain": domain})
    single = {k: v.float() for k, v in weights.items()}
    model.load_state_dict({k: v for k, v in single.items() if not k.startswith("doubt.")})
    doubt.load_state_dict({k.removeprefix("doubt."): v for k, v in single.items() if k.startswith("doubt.")})
    ends = ap.Scene.of_points(NEAR, radar=radar).simulate(floor="exact").ends
    given = ap.live_input(ends, radar)
    with torch.no_grad():
        log, minimum, picture = model.with_picture(*(torch.from_numpy(given[name])[None] for name in ("fine", "coarse", "rows", "scalars", "constants")))
        of_cells, hidden = doubt.parts(picture)
        error = expected_error(of_cells, doubt.scene(hidden)[:, 0], radar.elements)

    class Request:
        normalisation = "min-max"

    found, _ = Estimator(path)(ends, radar, Request)
    tensors = {
        "log": log[0, ::3].contiguous(), "minimum": minimum, "doubt": error[0, ::3].contiguous(),
        "lambda": torch.from_numpy(found[::3].copy()), "points": torch.from_numpy(NEAR).float(),
    }
    save_file(tensors, f"{folder}/shape_reference.safetensors", metadata={"network": "live-reference"})


def thesis(folder):
    torch.manual_seed(3)
    model = Thesis(3, 3)
    with torch.no_grad():
        for name, t in model.state_dict().items():
            if name.endswith("running_mean") or name.endswith("bias"):
                t.normal_(0, 0.2)
            elif name.endswith("running_var"):
                t.uniform_(0.3, 2)
    model.eval()
    x = torch.randn(1, 4, 16, 32)
    with torch.no_grad():
        out = model(x)
    save_file(model.state_dict(), f"{folder}/thesis_reference_weights.safetensors")
    torch.save(model.state_dict(), f"{folder}/thesis_reference_weights.pt")
    save_file({"input": x, "output": out}, f"{folder}/thesis_reference.safetensors")


main(sys.argv[1])
shape(sys.argv[1])
thesis(sys.argv[1])
