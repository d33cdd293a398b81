#!/usr/bin/env python3
"""Range-angle map of a shipped recording, word for word by NumPy: the reference that a test compares with.

    comparisons/reference_maps.py            # writes tests/data/chip-8-map.npy

Decades of amplitude, log10(|Y| + 1e-20), [range bins, columns], float64: symmetric Hann windows over samples and elements, DFT over
the samples, DFT over the elements, orthonormal, rolled so that cos(theta) rises with the column.
"""

import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent


def range_angle_map(samples):
    """`samples` [elements, samples] to decades [range bins, columns]."""
    elements, count = samples.shape
    profiles = np.fft.fft(samples * np.hanning(count), axis=1, norm="ortho")
    beams = np.fft.fft(profiles * np.hanning(elements)[:, None], axis=0, norm="ortho")
    return np.log10(np.abs(np.roll(beams, elements // 2, axis=0).T) + 1e-20)


def main():
    chirps = np.load(ROOT / "assets/recordings/chip-8.npz")["samples"].astype(np.complex128)
    decades = range_angle_map(chirps[0])
    np.save(ROOT / "tests/data/chip-8-map.npy", decades)
    bin_, column = np.unravel_index(decades.argmax(), decades.shape)
    print(f"{decades.shape}, strongest {decades.max():.6f} at bin {bin_}, column {column}")


if __name__ == "__main__":
    main()
