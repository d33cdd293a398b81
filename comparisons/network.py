"""Times the shipped live network's forward pass in PyTorch and onnxruntime, beside what `apertura` takes.

    cargo build --release && python3 comparisons/network.py

Anything that is not installed is skipped with a message. All times are medians of 15 runs on two threads, without the features
(which only apertura computes inside its time).
"""
import copy
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
WEIGHTS = os.path.join(HERE, "..", "assets", "weights", "live.safetensors")
BINARY = os.path.join(HERE, "..", "target", "release", "apertura")
THREADS, RUNS = 2, 15


def median(run):
    run()
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return sorted(times)[RUNS // 2] * 1e3


def main():
    try:
        import torch
        from safetensors.torch import load_file
    except ImportError as missing:
        sys.exit(f"skipped: {missing.name} is not installed")
    sys.path.insert(0, os.path.join(HERE, "..", "training"))
    from live import Live

    torch.set_num_threads(THREADS)
    torch.manual_seed(0)
    model = Live()
    model.load_state_dict(load_file(WEIGHTS))
    model.eval()
    inputs = (torch.randn(1, 4, 512, 256), torch.randn(1, 10, 512, 64), torch.randn(1, 6, 512), torch.tensor([[-11.6, -5.4]]))
    with torch.no_grad():
        print(f"PyTorch {torch.__version__}: {median(lambda: model(*inputs)):.1f} ms")
        fast = copy.deepcopy(model).to(memory_format=torch.channels_last)
        print(f"PyTorch, channels last: {median(lambda: fast(*inputs)):.1f} ms")
    try:
        import onnx  # noqa: F401
        import onnxruntime
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "live.onnx")
            torch.onnx.export(model, inputs, path, dynamo=False, opset_version=17,
                              input_names=["fine", "coarse", "rows", "scalars"])
            options = onnxruntime.SessionOptions()
            options.intra_op_num_threads = THREADS
            session = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
            feed = {i.name: t.numpy() for i, t in zip(session.get_inputs(), inputs)}
            print(f"onnxruntime {onnxruntime.__version__}: {median(lambda: session.run(None, feed)):.1f} ms")
    except ImportError as missing:
        print(f"onnxruntime skipped: {missing.name} is not installed")
    if os.path.exists(BINARY):
        command = [BINARY, "evaluate", "--method", "live", "--set", "2", "--count", "15", "--json"]
        import json
        report = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        print(f"apertura, features included: {report['sets'][0]['methods'][0]['median_milliseconds']:.1f} ms")
    else:
        print("apertura skipped: build it with cargo build --release")


main()
