"""A program of one's own as a method."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import apertura as ap

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "python" / "examples"
SMALL = ap.Radar(elements=64, end_elements=8, samples=32)
ENDS = ap.Scene.of_points([[0.1, 1.2]], SMALL).simulate().ends


def command(path, *arguments):
    return " ".join(f'"{part}"' for part in (sys.executable, path, *arguments))


def started(folder, text, **options):
    path = folder / "own.py"
    path.write_text("import sys, time\nimport numpy as np\nimport apertura as ap\n" + text)
    return ap.Method.of_command(command(path), **options)


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def scaled(ends):
    """As the program scales them."""
    return ends * 2.0 ** -np.floor(np.log2(max(np.abs(ends.real).max(), np.abs(ends.imag).max())))


def test_the_matched_filter_draws_what_numpy_computes():
    method = ap.Method.of_command(command(EXAMPLES / "own_matched_filter.py"))
    assert method.name == "numpy-matched-filter" and "numpy-matched-filter" in ap.methods()
    maps = ap.Scene.of_points([[0.0, 30.0]]).simulate()
    found = method.reconstruct(maps.ends)
    decades = load("own_matched_filter").matched_filter(scaled(maps.ends), ap.Radar())
    expected = (decades - decades.min()) / (decades.max() - decades.min())
    assert found.map.shape == (512, 1024) and np.abs(found.map - expected).max() < 1e-5
    assert np.argmax(found.map.max(axis=1)) == np.argmax(maps.target.max(axis=1)), "the echo is seen in its range bin"


def test_an_own_method_is_evaluated_like_any_other():
    ap.Method.of_command(command(EXAMPLES / "own_matched_filter.py"))
    rows = ap.evaluate(["numpy-matched-filter", "baseline"], ["1"], count=1)
    assert [row["method"] for row in rows] == ["numpy-matched-filter", "baseline"]


def test_a_network_of_pytorch_answers_its_own_map():
    torch = pytest.importorskip("torch")
    method = ap.Method.of_command(command(EXAMPLES / "own_pytorch.py"), seconds=300)
    network, _ = load("own_pytorch").loaded()
    network.columns = SMALL.elements
    with torch.no_grad():
        expected = network(torch.from_numpy(scaled(ENDS))).numpy()
    assert np.abs(method.reconstruct(ENDS, SMALL).map - expected).max() < 1e-5


def test_the_live_network_by_onnxruntime_is_the_live_network(tmp_path):
    for module in ("torch", "onnx", "onnxruntime", "safetensors"):
        pytest.importorskip(module)
    path = tmp_path / "live.onnx"
    subprocess.run([sys.executable, ROOT / "training" / "export_onnx.py", path], check=True)
    method = ap.Method.of_command(command(EXAMPLES / "own_onnx.py", path), seconds=300)
    for kind in ("3", "clusters"):
        ends = ap.Scene.random(kind, seed=3).simulate().ends
        found, expected = method.reconstruct(ends), ap.method("live").reconstruct(ends)
        assert np.abs(found.map - expected.map).max() < 1e-3
        # The network's own threshold is no lower: it knows its doubt, too.
        assert found.eta <= expected.eta + 1e-3


def test_the_documented_program_without_the_package_answers(tmp_path):
    text = (ROOT / "docs" / "own-network.md").read_text()
    [program] = re.findall(r"```python\n(import io, json, sys\n.*?)```", text, re.DOTALL)
    path = tmp_path / "by_hand.py"
    path.write_text(program)
    method = ap.Method.of_command(command(path))
    assert method.name == "by-hand" and method.eta == 0.5
    assert method.reconstruct(ENDS, SMALL).map.shape == (32, 64)


def test_the_function_is_told_radar_and_noise(tmp_path):
    method = started(
        tmp_path,
        """
def own(ends, radar, request):
    assert ends.shape == (2, 8, 32) and radar.samples == 32 and request.noise.startswith("white=")
    assert request.normalisation == "db=40" and 1 <= max(abs(ends.real).max(), abs(ends.imag).max()) < 2
    return np.linspace(0, 1, radar.samples * radar.elements).reshape(radar.samples, radar.elements), 0.125
ap.serve(own, name="told", description="for tests", told="everything")
""",
    )
    found = method.reconstruct(ENDS, SMALL, floor="white=0.5", normalisation="db=40")
    assert found.map[-1, -1] == 1 and found.map[0, 0] == 0 and found.eta >= 0.125
    assert (method.description, method.told) == ("for tests", "everything")


FUNCTION = """
def own(ends, radar):
    print("a line of progress")
    {body}
ap.serve(own, name="{name}")
"""


@pytest.mark.parametrize(
    "name, body, words",
    [
        ("raises", "raise KeyError('layer 7')", "KeyError: 'layer 7'"),
        ("ends", "print('no memory', file=sys.stderr, flush=True); import os; os._exit(3)", "it ended (exit status: 3)"),
        ("hangs", "time.sleep(100)", "no answer within 3 s"),
        ("shape", "return np.zeros((3, 4))", "shape [3, 4]; expected [32, 64]"),
        ("nan", "return np.full((32, 64), np.nan)", "finite numbers only"),
        ("text", "return np.array('words')", "expected real numbers"),
        ("none", "return None", "expected real numbers"),
        ("threshold", "return np.zeros((32, 64)), 7", "is 7; expected 0 to 1"),
        ("decades", "return np.full((32, 64), -9.0)", "expected 0 to 1"),
    ],
)
def test_a_function_that_fails_is_told(tmp_path, name, body, words):
    method = started(tmp_path, FUNCTION.format(body=body, name=name), seconds=3 if name == "hangs" else 120)
    for _ in range(2):
        with pytest.raises(ValueError) as told:
            method.reconstruct(ENDS, SMALL)
        assert words in str(told.value) and str(told.value).startswith(name)
    if name == "ends":
        assert "no memory" in str(told.value)


def test_commands_that_are_no_methods_are_told(tmp_path):
    for text, words in (
        ("print('Loading ...')", 'wrote "Loading ..." on its standard output'),
        ("import nowhere", "No module named 'nowhere'"),
        ("ap.serve(print, name='live')", 'a method of this program is called "live"'),
        ("ap.serve(print, name='a b')", 'its name is "a b"'),
        ("ap.serve(print, answers='pictures')", "'pictures'; expected"),
    ):
        with pytest.raises(ValueError) as told:
            started(tmp_path, text)
        assert words in str(told.value)
    with pytest.raises(ValueError, match="can't be started"):
        ap.Method.of_command("/nowhere/program")
    with pytest.raises(ValueError, match="the command is empty"):
        ap.Method.of_command(" ")


def test_ctrl_c_stops_a_start_that_hangs(tmp_path):
    import signal
    import threading

    # A shell starts what runs in the background with Ctrl-C ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(1.0, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        started(tmp_path, "time.sleep(100)")
    timer.join()


def test_a_pipe_that_closes_ends_the_program(tmp_path):
    path = tmp_path / "own.py"
    path.write_text("import apertura as ap\nap.serve(lambda ends, radar: ends)\n")
    child = subprocess.Popen([sys.executable, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    child.stdout.close()
    _, errors = child.communicate(b'{"apertura":1,"ask":"hello","id":0,"arrays":[]}\n' * 3, timeout=60)
    assert b"Traceback" not in errors
