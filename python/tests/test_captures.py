"""Raw captures, opened as they are."""

import numpy as np
import pytest

import apertura as ap

CFG = """channelCfg 15 5 0
adcCfg 2 1
profileCfg 0 77 30 6 60 0 0 60 1 128 4000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 8 0 100 1 0
"""
C = 299792458.0


def capture():
    """Eight loops of two transmitters and four receivers, an echo at x = 1.1 m, y = 2.3 m, as I Q pairs."""
    frequency = 77e9 + 60e12 * (6e-6 + np.arange(128) / 4e6)
    half_wave = C / frequency.mean() / 2
    transmitters, receivers = np.array([0, 4]) * half_wave, np.arange(4) * half_wave
    middle = (transmitters.mean() + receivers.mean()) / 2
    way = lambda place: np.hypot(1.1 - (place - middle), 2.3)  # noqa: E731
    path = way(transmitters)[:, None, None] + way(receivers)[None, :, None]
    loop = 400 * np.exp(2j * np.pi * frequency * path / C)
    noise = np.random.default_rng(1).normal(0, 3, (2, 8, 2, 4, 128))
    samples = loop + noise[0] + 1j * noise[1]
    return np.stack([samples.real, samples.imag], -1).round().astype("<i2").tobytes()


def test_a_capture_is_opened_as_it_is(tmp_path):
    (tmp_path / "room.bin").write_bytes(capture())
    (tmp_path / "room.cfg").write_text(CFG)
    recording = ap.Recording.open(tmp_path / "room.bin")
    assert (recording.radar.elements, recording.radar.samples, recording.name) == (8, 128, "room")
    found = ap.method("iaa").reconstruct(recording.ends, recording.radar, floor=recording.floor)
    cos_theta, range_metres = found.detections[0, :2]
    assert abs(range_metres - np.hypot(1.1, 2.3)) < 0.08
    assert abs(cos_theta - 1.1 / np.hypot(1.1, 2.3)) < 0.03


def test_the_cfg_may_have_another_name(tmp_path):
    (tmp_path / "a.bin").write_bytes(capture())
    (tmp_path / "b.txt").write_text(CFG)
    assert ap.Recording.open(tmp_path / "a.bin", tmp_path / "b.txt").radar.samples == 128
    without = ap.Recording.open(tmp_path / "a.bin")
    assert without.radar.samples == 128 and any("No .cfg" in doubt for doubt in without.doubts)


def test_what_is_no_capture_raises(tmp_path):
    (tmp_path / "a.bin").write_bytes(b"")
    with pytest.raises(ValueError, match="0 bytes"):
        ap.Recording.open(tmp_path / "a.bin")
    with pytest.raises(OSError):
        ap.Recording.open(tmp_path / "no.bin")
    with pytest.raises(ValueError, match="config"):
        ap.Recording.open(tmp_path / "a.toml", tmp_path / "b.cfg")
