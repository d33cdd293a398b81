"""A method in 15 lines of NumPy: `apertura evaluate --method-command "python own_matched_filter.py"`.

Both ends as one aperture of 24 elements: the map of the whole array's samples with zeros where no element listens.
"""
import numpy as np

import apertura as ap


def matched_filter(ends, radar):
    whole = np.zeros((radar.elements, radar.samples), complex)
    whole[: radar.end_elements], whole[-radar.end_elements :] = ends
    weights = np.zeros(radar.elements)
    weights[: radar.end_elements] = weights[-radar.end_elements :] = np.hanning(radar.end_elements)
    profiles = np.fft.fft(whole * np.hanning(radar.samples), axis=1) * weights[:, None]
    spectrum = np.fft.fftshift(np.fft.fft(profiles, axis=0), axes=0)
    return np.log10(np.abs(spectrum.T) + 1e-12)


if __name__ == "__main__":
    ap.serve(matched_filter, name="numpy-matched-filter", answers="decades", eta=0.9)
