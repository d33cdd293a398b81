"""Writes the live network as a file of ONNX: `python3 export_onnx.py live.onnx [WEIGHTS.safetensors]`. Needs torch, safetensors and onnx.

Inputs: fine [1, 4, 512, 256], coarse [1, 10, 512, 64], rows [1, 6, 512], scalars [1, 2] and constants [1, 6]. Outputs: decades [1, 512, 1024] and minimum [1].
"""
import sys
from pathlib import Path

import torch

from common import fill, tensors_of
from apertura.live import COARSE_CHANNELS, CONSTANTS, FINE, GRID, ROWS, Live, parted, widened

SHIPPED = Path(__file__).resolve().parent.parent / "assets" / "weights" / "live.safetensors"


def live(weights=SHIPPED):
    """The live network with the weights of a file, without its doubt."""
    model = Live()
    fill(model, widened(parted(tensors_of(weights))[0]), weights)
    return model.eval()


def inputs():
    """Zeros in the shape of each input, in the order in which the network takes them."""
    return {
        "fine": torch.zeros(1, 4, ROWS, FINE),
        "coarse": torch.zeros(1, COARSE_CHANNELS, ROWS, GRID),
        "rows": torch.zeros(1, 6, ROWS),
        "scalars": torch.zeros(1, 2),
        "constants": torch.zeros(1, CONSTANTS),
    }


def main(path, weights=SHIPPED):
    names = list(inputs())
    torch.onnx.export(
        live(weights), tuple(inputs().values()), path, input_names=names, output_names=["decades", "minimum"], opset_version=17, dynamo=False
    )


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
