"""The three Lambda maps by other tools, one thread each: what NumPy users write, and what a careful one installs.

    python3 comparisons/maps.py TASK REFERENCE COUNT...

TASK is `thesis` (f64, the thesis' rounding floor, stretched from the smallest to the largest cell) or `fixed` (no floor, 100 dB below the
largest, every tool in the precision that 1e-6 asks for). REFERENCE is a folder with COUNT.npz for each number of reflectors: `x`, `y`
[reflectors] in metres, and `samples` [elements, 512], what the elements of `elements` sample without any floor. Prints one JSON object:
`rows` of tool, reflectors, median_ms and signal_error (largest error of a range cell, relative to the largest), and `missing`, the tools
that are not installed. `apertura bench` runs it beside its own figures.
"""

import json
import os
import sys
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[variable] = "1"

try:
    import numpy as np
except ImportError:
    sys.exit("NumPy is not installed")

ELEMENTS, END, SAMPLES = 1024, 12, 512
LIGHT, CARRIER, BANDWIDTH, POWER = 299_792_458.0, 77e9, 2e9, 100.0
WAVELENGTH = LIGHT / CARRIER
BIN = LIGHT / (2 * BANDWIDTH)
ELEMENT_X = (np.arange(ELEMENTS) - (ELEMENTS - 1) / 2) * WAVELENGTH / 2
# A tool is not tried with more reflectors once its median time exceeds this, seconds.
MAX_MEDIAN_SECONDS = 20.0


# --- From samples [samples, elements] to three maps, in the samples' own precision.

def lambda_map(profiles, fixed):
    """Range profiles [bins, channels] to Lambda [bins, columns]."""
    real = profiles.real.dtype
    windowed = profiles * np.hanning(profiles.shape[1]).astype(real)
    cells = np.fft.fftshift(np.fft.fft(windowed, ELEMENTS, axis=1, norm="ortho"), axes=1)
    decades = np.log10(np.abs(cells) + real.type(1e-20))
    high = decades.max()
    low = high - real.type(5) if fixed else decades.min()
    return np.clip((decades - low) / (high - low), 0, 1)


def maps_of(signal, fixed):
    real = signal.real.dtype
    profiles = np.fft.fft(signal * np.hanning(SAMPLES).astype(real)[:, None], axis=0, norm="ortho")
    return [lambda_map(part, fixed) for part in (profiles[:, :END], profiles[:, -END:], profiles)]


def echoes(x, y):
    """Distances in bins and wavelengths, amplitudes: [reflectors, elements]."""
    distance = np.hypot(ELEMENT_X - x[:, None], y[:, None])
    return distance / BIN, distance / WAVELENGTH, POWER / distance**2


def add_floor(signal, x, y, random):
    """Noise as strong as the rounding of the formula in f64 would have been."""
    _, waves, amplitude = echoes(x, y)
    variance = 1 / 12 * np.sum((amplitude * np.spacing(2 * np.pi * waves)) ** 2, axis=0)
    noise = random.standard_normal((2, SAMPLES, ELEMENTS))
    signal += (noise[0] + 1j * noise[1]) * np.sqrt(variance / 2)


# --- The tools: samples [samples, elements] without a floor of their own, unless they say so.

def numpy_plain(x, y):
    """One complex exponential per reflector, in complex128; its own rounding is the thesis' floor."""
    n1 = np.arange(SAMPLES)[:, None]
    signal = np.zeros((SAMPLES, ELEMENTS), complex)
    for xl, yl in zip(x, y):
        distance = np.hypot(ELEMENT_X - xl, yl)
        phase = 2 * np.pi * (n1 / SAMPLES * (distance / BIN) - distance / WAVELENGTH)
        signal += POWER / distance**2 * np.exp(1j * phase)
    return signal


def numpy_single(x, y):
    """The same with whole turns taken off in f64, the rest in complex64."""
    n1 = np.arange(SAMPLES)[:, None] / SAMPLES
    signal = np.zeros((SAMPLES, ELEMENTS), np.complex64)
    for xl, yl in zip(x, y):
        distance = np.hypot(ELEMENT_X - xl, yl)
        turns = n1 * (distance / BIN) - distance / WAVELENGTH
        turns -= np.rint(turns)
        phase = turns.astype(np.float32) * np.float32(2 * np.pi)
        signal += (POWER / distance**2).astype(np.float32) * np.exp(np.complex64(1j) * phase)
    return signal


def numba_split(real):
    """Phasors split at 32 samples, 512 = 16 * 32, whole turns taken off in f64; compiled."""
    import numba

    @numba.njit(fastmath=True)
    def fill(x, y, element_x, signal):
        rows_re, rows_im = np.empty(16, signal.dtype), np.empty(16, signal.dtype)
        columns_re, columns_im = np.empty(32, signal.dtype), np.empty(32, signal.dtype)
        for n in range(ELEMENTS):
            for xl, yl in zip(x, y):
                distance = np.sqrt((element_x[n] - xl) ** 2 + yl**2)
                bins, waves, amplitude = distance / BIN, distance / WAVELENGTH, POWER / distance**2
                for a in range(16):
                    turns = a * 32 / SAMPLES * bins - waves
                    angle = 2 * np.pi * (turns - np.rint(turns))
                    rows_re[a], rows_im[a] = amplitude * np.cos(angle), amplitude * np.sin(angle)
                for b in range(32):
                    turns = b / SAMPLES * bins
                    angle = 2 * np.pi * (turns - np.rint(turns))
                    columns_re[b], columns_im[b] = np.cos(angle), np.sin(angle)
                for a in range(16):
                    for b in range(32):
                        signal[0, n, a * 32 + b] += rows_re[a] * columns_re[b] - rows_im[a] * columns_im[b]
                        signal[1, n, a * 32 + b] += rows_re[a] * columns_im[b] + rows_im[a] * columns_re[b]

    def tool(x, y):
        signal = np.zeros((2, ELEMENTS, SAMPLES), real)
        fill(x, y, ELEMENT_X, signal)
        return np.ascontiguousarray((signal[0] + real(1) * 1j * signal[1]).T.astype(np.result_type(real, np.complex64)))

    return tool


def finufft(tolerance, kind):
    """A non-uniform transform over range for every element, its plan reused; in f64 (points in f32 alone would err by 3e-5)."""
    import finufft

    plan = finufft.Plan(1, (SAMPLES,), eps=tolerance, isign=1, dtype="complex128", nthreads=1)
    half = SAMPLES // 2

    def tool(x, y):
        bins, waves, amplitude = echoes(x, y)
        turns = bins / SAMPLES
        # Modes are counted from the middle of the chirp.
        start = (amplitude * np.exp(2j * np.pi * np.mod(turns * half - waves, 1))).T.copy()
        points = (2 * np.pi * (turns - np.rint(turns))).T.copy()
        signal = np.empty((ELEMENTS, SAMPLES), kind)
        for n in range(ELEMENTS):
            plan.setpts(points[n])
            signal[n] = plan.execute(start[n])
        return signal.T.copy()

    return tool


def tools(task):
    """Name, maker of the samples, and whether the floor is still to be laid down."""
    if task == "thesis":
        return [
            ("NumPy, complex128", lambda: numpy_plain, False),
            ("numba, phasor split, f64", lambda: numba_split(np.float64), True),
            ("FINUFFT, 1e-12", lambda: finufft(1e-12, np.complex128), True),
        ]
    return [
        ("NumPy, complex64", lambda: numpy_single, False),
        ("numba, phasor split, f32", lambda: numba_split(np.float32), False),
        ("FINUFFT, 1e-7", lambda: finufft(1e-7, np.complex64), False),
    ]


def main():
    task, folder, counts = sys.argv[1], sys.argv[2], [int(a) for a in sys.argv[3:]]
    random = np.random.default_rng(0)
    rows, missing = [], []
    for name, make, floor in tools(task):
        try:
            samples = make()
        except ImportError as error:
            missing.append(f"{name}: {error.name} is not installed")
            continue

        def run(x, y):
            signal = samples(x, y)
            if floor:
                add_floor(signal, x, y, random)
            return maps_of(signal, task == "fixed")

        slow = False
        for count in counts:
            if slow:
                continue
            reference = np.load(os.path.join(folder, f"{count}.npz"))
            x, y = reference["x"], reference["y"]
            found = samples(x, y)[:, reference["elements"].astype(int)].T
            window = np.hanning(SAMPLES)
            found, judged = (np.fft.fft(v.astype(complex) * window) for v in (found, reference["samples"]))
            error = np.abs(found - judged).max() / np.abs(judged).max()
            times = []
            for _ in range(3 if count > 50 else 7):
                start = time.perf_counter()
                run(x, y)
                times.append(1e3 * (time.perf_counter() - start))
            median = sorted(times)[len(times) // 2]
            rows.append({"tool": name, "reflectors": count, "median_ms": median, "signal_error": float(error)})
            slow = median > 1e3 * MAX_MEDIAN_SECONDS
    print(json.dumps({"rows": rows, "missing": missing}))


if __name__ == "__main__":
    main()
