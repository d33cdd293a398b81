"""Times the shipped live network's forward pass in PyTorch and onnxruntime, beside what `apertura` takes.

    cargo build --release && python3 comparisons/network.py

Anything that is not installed is skipped with a message. All times are medians of 15 runs on two threads, of the network alone: the features,
which every one of them needs, stand by themselves. apertura's network leaves out what doesn't show in a scene's map (most of the side lobes in
range), which no other does. So its time with nothing left out is held against theirs first, dense against dense, and then its time as it ships.
"""
import copy
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
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


def shipped():
    """The module that loads the shipped network and writes it as ONNX."""
    sys.path.insert(0, os.path.join(HERE, "..", "training"))
    import export_onnx

    return export_onnx


def main():
    try:
        import torch

        network = shipped()
    except ImportError as missing:
        sys.exit(f"skipped: {missing.name} is not installed")
    torch.set_num_threads(THREADS)
    torch.manual_seed(0)
    model = network.live()
    inputs = {name: torch.randn_like(zeros) for name, zeros in network.inputs().items()}
    inputs["scalars"] = torch.tensor([[-11.6, -5.4]])
    inputs["constants"] = network.inputs()["constants"]
    others = {}
    with torch.no_grad():
        others[f"PyTorch {torch.__version__}"] = median(lambda: model(**inputs))
        fast = copy.deepcopy(model).to(memory_format=torch.channels_last)
        others["PyTorch, channels last"] = median(lambda: fast(**inputs))
    try:
        import onnx  # noqa: F401
        import onnxruntime

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "live.onnx")
            network.main(path)
            options = onnxruntime.SessionOptions()
            options.intra_op_num_threads = THREADS
            session = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
            feed = {name: values.numpy() for name, values in inputs.items()}
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
    print(f"apertura: {dense:.1f} ms with nothing left out, {sparse:.1f} ms as it ships; features before either {own['features_milliseconds']:.1f} ms")
    for name, ms in others.items():
        print(f"{name}: {ms:.1f} ms; apertura takes {dense / ms:.2f} of it dense against dense, {sparse / ms:.2f} as it ships")


if __name__ == "__main__":
    main()
