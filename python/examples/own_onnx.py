"""A network in a file of ONNX as a method: `apertura --method-command "python own_onnx.py live.onnx"`.

The file has the live network's inputs (`ap.live_input`) and answers decades and their minimum: `python training/export_onnx.py live.onnx`
makes it of the shipped weights.
"""
import sys

import numpy as np
import onnxruntime

import apertura as ap

#: Cells this many decades below the strongest are no detections.
BELOW_PEAK_DECADES = 3.3


def method(path):
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])

    def reconstruct(ends, radar):
        given = ap.live_input(ends, radar)
        inputs = {name: given[name][None] for name in ("fine", "coarse", "rows", "scalars", "constants")}
        decades, minimum = (output[0] for output in session.run(["decades", "minimum"], inputs))
        spread = decades.max() - minimum
        return np.clip((decades - minimum) / spread, 0, 1), np.clip(1 - BELOW_PEAK_DECADES / spread, 0, 1)

    return reconstruct


if __name__ == "__main__":
    ap.serve(method(sys.argv[1]), name="own-onnx", description="a network that onnxruntime runs", eta=0.8)
