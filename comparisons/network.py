"""Times the shipped live network's forward pass in PyTorch and onnxruntime, beside what `apertura` takes.

    cargo build --release && python3 comparisons/network.py

Anything that is not installed is skipped with a message. All times are medians of 15 runs on two threads, of the network alone: the features,
which every one of them needs, stand by themselves. apertura's network leaves out what doesn't show in a scene's map (most of the side lobes in
range), which no other does; so its time is given as it ships and with nothing left out, and both are held against the others.
"""
import copy
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
WEIGHTS = os.path.join(HERE, "..", "assets", "weights", "live.safetensors")
BINARY = os.environ.get("APERTURA", os.path.join(HERE, "..", "target", "release", "apertura"))
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
    from live import CONSTANTS, Live, parted, widened

    torch.set_num_threads(THREADS)
    torch.manual_seed(0)
    model = Live()
    model.load_state_dict(widened(parted(load_file(WEIGHTS))[0]))
    model.eval()
    inputs = (torch.randn(1, 4, 512, 256), torch.randn(1, 10, 512, 64), torch.randn(1, 6, 512), torch.tensor([[-11.6, -5.4]]),
              torch.zeros(1, CONSTANTS))
    others = {}
    with torch.no_grad():
        others[f"PyTorch {torch.__version__}"] = median(lambda: model(*inputs))
        fast = copy.deepcopy(model).to(memory_format=torch.channels_last)
        others["PyTorch, channels last"] = median(lambda: fast(*inputs))
    try:
        import onnx  # noqa: F401
        import onnxruntime
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "live.onnx")
            torch.onnx.export(model, inputs, path, dynamo=False, opset_version=17,
                              input_names=["fine", "coarse", "rows", "scalars", "constants"])
            options = onnxruntime.SessionOptions()
            options.intra_op_num_threads = THREADS
            session = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
            feed = {i.name: t.numpy() for i, t in zip(session.get_inputs(), inputs)}
            others[f"onnxruntime {onnxruntime.__version__}"] = median(lambda: session.run(None, feed))
    except ImportError as missing:
        print(f"onnxruntime skipped: {missing.name} is not installed")
    report(others)


def report(others):
    """Prints the times of all, and apertura's as parts of theirs."""
    if not os.path.exists(BINARY):
        print("apertura skipped: build it with cargo build --release")
        for name, ms in others.items():
            print(f"{name}: {ms:.1f} ms")
        return
    environment = {**os.environ, "RAYON_NUM_THREADS": str(THREADS)}
    own = json.loads(subprocess.run([BINARY, "bench", "--live", "--json"], check=True, capture_output=True, text=True, env=environment).stdout)
    sparse, dense = own["forward_milliseconds"], own["dense_forward_milliseconds"]
    print(f"apertura: {sparse:.1f} ms as it ships, {dense:.1f} ms with nothing left out; features before either {own['features_milliseconds']:.1f} ms")
    for name, ms in others.items():
        print(f"{name}: {ms:.1f} ms; apertura takes {sparse / ms:.2f} of it as it ships, {dense / ms:.2f} dense against dense")


main()
