"""Disks without room, devices and pipes whose other end is gone: an exception or an ordinary end, never an abort or a hang."""

import re
import subprocess
import sys

import pytest

import apertura as ap

ON_UNIX = pytest.mark.skipif(sys.platform == "win32", reason="there are no such limits, devices and pipes")

#: Writes of every kind; `disk` makes room scarce first.
WRITES = """
import os
import apertura as ap
rows = ap.evaluate(["baseline"], ["1"], count=1)
points = ap.Scene.of_points([[1.0, 2.0 + 0.001 * i] for i in range(5000)])
{disk}
for name, write in (
    ("data", lambda: ap.dataset("data", [1], count=1)),
    ("rows.csv", lambda: ap.write_rows("rows.csv", [{{**rows[0], "index": i}} for i in range(2000)])),
    ("scene.toml", lambda: points.save("scene.toml")),
    ("scene.npz", lambda: ap.Scene.of_points([[i, 2.0] for i in range(20000)]).save("scene.npz")),
):
    try:
        write()
    except OSError as error:
        print("told:", error if name in str(error) else f"{{error}} without {{name}}")
print(*sorted(name for _, _, names in os.walk(".") for name in names))
"""

#: A limit on the length of files, which needs no rights.
SHORT_FILES = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 15, 1 << 15))"


def written(folder, disk):
    """What the system said of all writes alike, and the names of what they left."""
    found = subprocess.run([sys.executable, "-c", WRITES.format(disk=disk)], cwd=folder, capture_output=True, text=True, timeout=300)
    *told, left = found.stdout.splitlines()
    assert found.returncode == 0 and len(told) == 4 and all(line.startswith("told:") and "without" not in line for line in told), found
    [words] = {re.fullmatch(r".*: (.+) \(os error \d+\)", line)[1] for line in told}
    return words, left.split()


@ON_UNIX
def test_a_file_that_may_not_grow_leaves_no_part(tmp_path):
    assert written(tmp_path, SHORT_FILES) == ("File too large", [])


@pytest.fixture
def tiny_disk(tmp_path):
    options = ["-t", "tmpfs", "-o", "size=64k", "tmpfs", str(tmp_path)]
    if sys.platform != "linux" or subprocess.run(["mount", *options], capture_output=True).returncode != 0:
        pytest.skip("no right to mount a disk of 64 kB")
    yield tmp_path
    subprocess.run(["umount", "--lazy", str(tmp_path)], check=True)


def test_a_full_disk_leaves_no_part_of_a_file(tiny_disk):
    assert written(tiny_disk, "") == ("No space left on device", [])


@ON_UNIX
def test_devices_are_no_files():
    rows = ap.evaluate(["baseline"], ["1"], count=1)
    for use in (
        lambda: ap.evaluate(["baseline"], ["1"], count=1, path="/dev/full"),
        lambda: ap.write_rows("/dev/full", rows),
        lambda: ap.read_rows("/dev/full"),
        lambda: ap.Recording.load("/dev/full"),
        lambda: ap.dataset("/dev/full", [1], count=1),
        lambda: ap.data.Files("/dev/full"),
    ):
        with pytest.raises((OSError, ValueError), match="/dev/full"):
            use()


def to_a_reader_that_leaves(*command):
    """Runs Python with a standard output whose reader leaves after one line."""
    child = subprocess.Popen([sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.readline()
    child.stdout.close()
    errors = child.stderr.read()
    return child.wait(120), errors


@ON_UNIX
def test_a_reader_that_leaves_ends_long_work():
    program = 'import apertura as ap; ap.evaluate(["baseline"], [3], count=100_000, on_row=lambda row: print(row, flush=True))'
    status, errors = to_a_reader_that_leaves("-c", program)
    assert status == 1 and "BrokenPipeError" in errors and "panicked" not in errors


LEAVES = """
import os, sys, time
sys.stdin.buffer.readline()
os.write(1, b'{{"apertura":1,"id":0,"name":"{name}","arrays":[]}}\\n')
{after}
"""


@ON_UNIX
@pytest.mark.parametrize(
    "name, after",
    [
        ("deaf", "os.close(0); time.sleep(100)"),
        ("mute", "sys.stdin.buffer.readline(); os.close(1); os.close(2); time.sleep(100)"),
        ("gone", "os._exit(0)"),
        ("cut", "sys.stdin.buffer.readline(); os.write(1, b'{\"apertura\":1,'); os._exit(0)"),
        ("endless", "sys.stdin.buffer.readline()\nwhile True: os.write(1, bytes(1 << 16))"),
    ],
)
def test_a_program_that_closes_its_pipes_is_told(tmp_path, name, after):
    path = tmp_path / "own.py"
    path.write_text(LEAVES.format(name=name, after=after))
    small = ap.Radar(elements=64, end_elements=8, samples=32)
    ends = ap.Scene.of_points([[0.1, 1.2]], small).simulate().ends
    method = ap.Method.of_command(f'"{sys.executable}" "{path}"', seconds=5)
    for _ in range(2):
        with pytest.raises(ValueError, match=f"^{name}"):
            method.reconstruct(ends, small)
