"""Scenes and the exact radar signal, for training the live network.

The generators are those of the thesis' tables (sets 1, 2, 3), of its second experiment, and of the kinds beside them. Everything is computed in
complex128 with phases reduced to turns; the thesis' rounding floor is added as white noise of the matching variance.
Seeds: every split draws from its own key of a counter-based generator, so that no two splits share a stream.
"""
import math

import numpy as np
import torch

C = 299_792_458.0
BANDWIDTH = 2e9
WAVELENGTH = C / 77e9
RANGE_BIN = C / (2 * BANDWIDTH)
N_R, N_A, N_E = 512, 1024, 12
R_MAX = N_R * RANGE_BIN
ELEMENTS = (np.arange(N_A) - (N_A - 1) / 2) * WAVELENGTH / 2
LINE_POINTS = 75
SPLITS = {"train": 1, "validation": 2, "test": 3}


def rng_for(split, seed, index):
    """Generator of scene `index` of a split; the split's number is part of the key, so streams never coincide."""
    return np.random.Generator(np.random.Philox(key=(SPLITS[split] << 56) + seed, counter=[0, 0, 0, index]))


def random_point(rng):
    r = rng.normal(R_MAX / 2, 0.3 * R_MAX)
    if r < 0.2 * R_MAX or r > 0.8 * R_MAX:
        r = 0.8 * R_MAX
    a = float(np.clip(rng.normal(), -0.8 * math.pi, 0.8 * math.pi))
    return np.array([[r * math.cos(a), r * math.sin(a)]])


def line_start(rng):
    return rng.uniform(-1, 1) * R_MAX, rng.uniform(0, 1) * R_MAX


def line(start):
    x = float(np.clip(start[0], -0.8 * R_MAX, 0.8 * R_MAX))
    step = 1.5 * RANGE_BIN
    y = min(start[1], 0.9 * R_MAX - LINE_POINTS * step)
    ys = y + step * np.arange(LINE_POINTS)
    return np.stack([np.full(LINE_POINTS, x), ys], 1)


def scene_set1(rng):
    return random_point(rng)


def scene_set2(rng):
    return np.concatenate([random_point(rng) for _ in range(rng.integers(3, 7))])


def scene_set3(rng):
    n = rng.integers(3, 7)
    start = line_start(rng)
    r = math.hypot(*start) + rng.uniform(0, 50) * RANGE_BIN
    a = rng.uniform(-math.pi / 2, math.pi / 2)
    parts = [line(start), np.array([[r * math.cos(a), r * math.sin(a)]])]
    for _ in range(n - 2):
        parts.append(random_point(rng) if rng.random() < 0.5 else line(line_start(rng)))
    return np.concatenate(parts)


def scene_experiment2(rng):
    n = rng.integers(1, 5)
    parts = [random_point(rng) if rng.random() < 0.5 else line(line_start(rng)) for _ in range(n)]
    return np.concatenate(parts)


# The kinds beside the thesis' sets. They follow the descriptions of `src/scene/generate/kind.rs`, drawn here from streams of their own.
# A scene is an array [L, 2] of positions in metres, or [L, 3] with reflectivities.

NEAREST, FARTHEST, MARGIN = 2.0, 0.95 * R_MAX, math.radians(5)


def polar(r, rng, margin=MARGIN):
    a = rng.uniform(margin, math.pi - margin)
    return np.array([r * math.cos(a), r * math.sin(a)])


def place(rng):
    return polar(rng.uniform(NEAREST, FARTHEST), rng)


def places(rng, low, high):
    return [place(rng)[None] for _ in range(rng.integers(low, high + 1))]


def holds(end):
    return end[1] >= NEAREST * math.sin(MARGIN) and NEAREST <= math.hypot(*end) <= FARTHEST


def segment(start, direction, spacing, count):
    return start + np.arange(count)[:, None] * spacing * np.array([math.cos(direction), math.sin(direction)])


def wall(rng, direction, spacing, low=20, high=100):
    count = int(rng.integers(low, high + 1))
    while True:
        for _ in range(100):
            points = segment(place(rng), direction, spacing, count)
            if count <= low or holds(points[-1]):
                return points
        count = max(low, count // 2)


def any_direction(rng):
    return rng.uniform(0, 2 * math.pi)


def spacing(rng, most=3.0):
    return rng.uniform(0.5, most) * RANGE_BIN


def cluster(rng):
    return place(rng) + rng.normal(size=(rng.integers(15, 41), 2)) * rng.uniform(0.2, 1, 2)


def scene_clusters(rng):
    return np.concatenate([cluster(rng) for _ in range(rng.integers(1, 4))] + places(rng, 1, 3))


def scene_walls(rng):
    return np.concatenate([wall(rng, any_direction(rng), spacing(rng)) for _ in range(rng.integers(1, 4))] + places(rng, 1, 3))


def scene_spacings(rng):
    return np.concatenate([wall(rng, math.pi / 2, spacing(rng)) for _ in range(rng.integers(1, 4))] + places(rng, 1, 3))


def scene_corner(rng):
    while True:
        direction = any_direction(rng)
        first = wall(rng, direction, spacing(rng, 2), 20, 80)
        second = segment(first[0], direction + math.pi / 2, spacing(rng, 2), int(rng.integers(20, 81)))
        if holds(first[-1]) and holds(second[-1]):
            return np.concatenate([first, second, cluster(rng), place(rng)[None]])


def scene_crowd(rng):
    return np.concatenate(places(rng, 12, 40))


def with_decibels(points, decibels):
    return np.concatenate([points, 10 ** (np.asarray(decibels)[:, None] / 20)], 1)


def scene_dynamic(rng):
    return with_decibels(np.concatenate(places(rng, 5, 5)), [0, *rng.uniform(-40, 0, 4)])


def near_point(rng):
    return polar(0.3 * (8 / 0.3) ** rng.random(), rng, math.radians(15))[None]


def scene_near(rng):
    return np.concatenate([near_point(rng) for _ in range(rng.integers(1, 4))])


def scene_field(rng):
    """Anything anywhere: 1 to 6 objects (points, near points, bunches of 1 to 10 points, segments from 8 points, clusters), each up to 60 dB weaker
    than the strongest, from 0.3 m to the maximum range."""
    parts = []
    for _ in range(rng.integers(1, 7)):
        u = rng.random()
        if u < 0.35:
            part = polar(rng.uniform(0.3, 0.99 * R_MAX), rng, math.radians(1))[None]
        elif u < 0.45:
            part = near_point(rng)
        elif u < 0.6:
            part = np.concatenate(places(rng, 1, 10))
        elif u < 0.85:
            part = wall(rng, any_direction(rng), spacing(rng), 8, 100)
        else:
            part = cluster(rng)
        parts.append(with_decibels(part, np.full(len(part), -60 * rng.random() ** 2)))
    return np.concatenate(parts)


GENERATORS = {1: scene_set1, 2: scene_set2, 3: scene_set3, "exp2": scene_experiment2, "clusters": scene_clusters, "walls": scene_walls,
              "spacings": scene_spacings, "corner": scene_corner, "crowd": scene_crowd, "dynamic": scene_dynamic, "near": scene_near,
              "field": scene_field}
#: Share of each kind in the live network's training.
MIXTURE = {1: 4, 2: 12, 3: 14, "clusters": 9, "walls": 12, "spacings": 6, "corner": 10, "crowd": 15, "dynamic": 5, "near": 5, "field": 8}


def mixture(rng):
    """A scene of the training mixture."""
    shares = np.cumsum(list(MIXTURE.values()))
    return GENERATORS[list(MIXTURE)[int(np.searchsorted(shares, rng.random() * shares[-1], "right"))]](rng)


def _unit(turns):
    turns = turns - torch.round(turns)
    return torch.polar(torch.ones_like(turns), turns * (2 * math.pi))


def _powers(w, n):
    """w^0 .. w^(n-1) along a new last axis, by doubling (n a power of two)."""
    out = torch.ones(*w.shape, n, dtype=w.dtype)
    out[..., 1] = w
    k = 2
    step = w * w
    while k < n:
        torch.mul(out[..., :k], step[..., None], out=out[..., k : 2 * k])
        step = step * step
        k *= 2
    return out


def simulate(points, rng, floor=True, snr_db=None):
    """Samples [512, 1024] complex128 of all elements for reflectors `points` [L, 2] in metres ([L, 3] with reflectivity), over the thesis' rounding floor
    or, where `snr_db` is given, over thermal noise at this ratio to the mean power of all samples."""
    pts = torch.from_numpy(points)
    xs = torch.from_numpy(ELEMENTS)
    y = torch.zeros(N_A, 16, 32, dtype=torch.complex128)
    variance = torch.zeros(N_A, dtype=torch.float64)
    for chunk in pts.split(64):
        r = torch.sqrt((xs[:, None] - chunk[None, :, 0]) ** 2 + chunk[None, :, 1] ** 2)
        amplitude = 100.0 / (r * r)
        if chunk.shape[1] == 3:
            amplitude = amplitude * chunk[None, :, 2]
        step = _unit(r / (RANGE_BIN * N_R))
        carrier = _unit(-r / WAVELENGTH) * amplitude
        fine = _powers(step, 32)
        coarse = _powers(fine[..., 31] * step, 16) * carrier[..., None]
        y += coarse.transpose(1, 2) @ fine
        ulp = torch.exp2(torch.floor(torch.log2(2 * math.pi * r / WAVELENGTH)) - 52)
        variance += (amplitude**2 * ulp**2).sum(1) / 12 * 1.5
    y = y.reshape(N_A, N_R).T
    if snr_db is not None:
        variance[:] = (y.abs() ** 2).mean() / 10 ** (snr_db / 10)
    if floor:
        g = torch.Generator().manual_seed(int(rng.integers(1 << 62)))
        noise = torch.randn(N_R, N_A, 2, dtype=torch.float32, generator=g).double()
        y = y + torch.view_as_complex(noise) * torch.sqrt(variance / 2)[None, :]
    return y


def hann(n):
    return torch.from_numpy(np.hanning(n))


def log_map(y):
    """log10 |Y| [512, 1024] float32 of the full array."""
    y = y * hann(N_R)[:, None] * hann(N_A)[None, :]
    m = torch.fft.fft2(y, norm="ortho").roll(N_A // 2, 1)
    return (0.5 * torch.log10(m.real**2 + m.imag**2 + 1e-40)).float()


def ends(y):
    """Samples of the two ends [2, 12, 512] complex128."""
    return torch.stack([y[:, :N_E].T, y[:, -N_E:].T])
