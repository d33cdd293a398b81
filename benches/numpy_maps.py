"""What a NumPy user would write for the three Lambda maps: one complex exponential per reflector, in complex128.

Prints one JSON object: reflectors -> median milliseconds. `apertura bench` runs it beside its own figures.
Usage: python3 numpy_maps.py [REFLECTORS ...]
"""

import json
import sys
import time

try:
    import numpy as np
except ImportError:
    sys.exit("NumPy is not installed")

ELEMENTS, END, SAMPLES = 1024, 12, 512
LIGHT, CARRIER, BANDWIDTH, POWER = 299_792_458.0, 77e9, 2e9, 100.0
WAVELENGTH = LIGHT / CARRIER
BIN = LIGHT / (2 * BANDWIDTH)


def lambda_map(profiles):
    """Range profiles [bins, channels] to Lambda [bins, columns]."""
    windowed = profiles * np.hanning(profiles.shape[1])
    cells = np.fft.fftshift(np.fft.fft(windowed, ELEMENTS, axis=1, norm="ortho"), axes=1)
    decades = np.log10(np.abs(cells) + 1e-20)
    low = decades.min()
    return (decades - low) / (decades.max() - low)


def maps(x, y):
    """Lambda of the first end, the last end and the whole array."""
    element_x = (np.arange(ELEMENTS) - (ELEMENTS - 1) / 2) * WAVELENGTH / 2
    n1 = np.arange(SAMPLES)[:, None]
    signal = np.zeros((SAMPLES, ELEMENTS), complex)
    for xl, yl in zip(x, y):
        distance = np.hypot(element_x - xl, yl)
        phase = 2 * np.pi * (n1 / SAMPLES * (distance / BIN) - distance / WAVELENGTH)
        signal += POWER / distance**2 * np.exp(1j * phase)
    profiles = np.fft.fft(signal * np.hanning(SAMPLES)[:, None], axis=0, norm="ortho")
    return [lambda_map(part) for part in (profiles[:, :END], profiles[:, -END:], profiles)]


def main():
    counts = [int(a) for a in sys.argv[1:]] or [1, 10, 75, 300]
    medians = {}
    for count in counts:
        i = np.arange(count)
        x, y = i * 37 % 61 - 30.0, 2.37 + i * 53 % 33
        times = []
        for _ in range(3 if count > 50 else 7):
            start = time.perf_counter()
            maps(x, y)
            times.append(1e3 * (time.perf_counter() - start))
        medians[str(count)] = sorted(times)[len(times) // 2]
    print(json.dumps(medians))


if __name__ == "__main__":
    main()
