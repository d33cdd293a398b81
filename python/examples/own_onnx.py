"""A network in a file of ONNX as a method: `apertura --method-command "python own_onnx.py live.onnx"`.

The file has the live network's inputs (`ap.live_input`) and answers decades and their minimum: `python training/export_onnx.py live.onnx`
makes it of the shipped weights.
"""
import sys

import numpy as np
import onnxruntime

import apertura as ap

#: The part of the answer's cells at or below 0.9 that may exceed the threshold; the file of ONNX says nothing of the answer's doubt.
FALSE_ALARM = 0.0092


def method(path):
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])

    def reconstruct(ends, radar):
        given = ap.live_input(ends, radar)
        inputs = {name: given[name][None] for name in ("fine", "coarse", "rows", "scalars", "constants")}
        decades, minimum = (output[0] for output in session.run(["decades", "minimum"], inputs))
        answer = np.clip((decades - minimum) / (decades.max() - minimum), 0, 1)
        return answer, min(np.quantile(answer[answer <= 0.9], 1 - FALSE_ALARM), 0.896)

    return reconstruct


if __name__ == "__main__":
    ap.serve(method(sys.argv[1]), name="own-onnx", description="a network that onnxruntime runs", eta=0.8)
