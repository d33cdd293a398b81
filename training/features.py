"""Input tensors of the live network, from the raw samples of the two ends.

Fine features live on a 512 x 256 polar grid (every 4th of the 1024 angle columns), smooth ones on 512 x 64.
"""
import math

import numpy as np
import torch

from scenes import ELEMENTS, N_E, N_R, R_MAX, RANGE_BIN, WAVELENGTH, hann

SUB = 8  # elements of a subarray
LOADING = 1e-5
FINE, COARSE = 256, 64
END_X = np.array([ELEMENTS[:N_E].mean(), ELEMENTS[-N_E:].mean()])


def _cosines(n):
    return (np.arange(n) - n // 2) / (n / 2)


def _gather_table(n, source_x, target_x):
    """Bilinear table: for each cell of the polar grid centred on `source_x`, where it lies on that of `target_x`."""
    r = np.arange(N_R)[:, None] * RANGE_BIN
    u = _cosines(n)[None, :]
    dx = r * u + source_x - target_x
    dy2 = r * r * (1 - u * u)
    r2 = np.sqrt(dx * dx + dy2)
    u2 = np.divide(dx, r2, out=np.zeros_like(r2), where=r2 > 0)
    row = np.clip(r2 / RANGE_BIN, 0, N_R - 1)
    col = u2 * (n / 2) + n // 2
    r0 = np.minimum(np.floor(row).astype(int), N_R - 2)
    c0 = np.floor(col).astype(int)
    fr, fc = row - r0, col - c0
    c1 = (c0 + 1) % n
    c0 = c0 % n
    index = np.stack([r0 * n + c0, r0 * n + c1, (r0 + 1) * n + c0, (r0 + 1) * n + c1])
    weight = np.stack([(1 - fr) * (1 - fc), (1 - fr) * fc, fr * (1 - fc), fr * fc])
    return torch.from_numpy(index.reshape(4, -1)), torch.from_numpy(weight.reshape(4, -1)).float()


TABLES = {
    (n, a, b): _gather_table(n, xa, xb)
    for n in (FINE, COARSE)
    for a, xa in (("c", 0.0), (0, END_X[0]), (1, END_X[1]))
    for b, xb in ((0, END_X[0]), (1, END_X[1]))
    if a != b and not (n == COARSE and a != "c")
}


def _register(image, n, a, b):
    index, weight = TABLES[(n, a, b)]
    flat = image.reshape(-1)
    return (flat[index[0]] * weight[0] + flat[index[1]] * weight[1] + flat[index[2]] * weight[2]
            + flat[index[3]] * weight[3]).reshape(N_R, n)


def _steering(n):
    # element m of an end, beam k: the signal of a reflector at cos u is exp(+j pi u m)
    return torch.from_numpy(np.exp(-1j * np.pi * np.outer(np.arange(N_E), _cosines(n))))


BEAMS = hann(N_E)[:, None] * _steering(COARSE) / math.sqrt(1024)
_LAG = np.pi * np.outer(np.arange(SUB), _cosines(FINE))
COS_LAG, SIN_LAG = torch.from_numpy(np.cos(_LAG)).float(), torch.from_numpy(np.sin(_LAG)).float()


def capon(z):
    """log10 amplitude [512, 256] of the Capon spectrum of each row of z [512, 12], forward-backward smoothed."""
    snapshots = torch.stack([z[:, i : i + SUB] for i in range(N_E - SUB + 1)], 2)
    snapshots = torch.cat([snapshots, snapshots.flip(1).conj()], 2)
    cov = snapshots @ snapshots.transpose(1, 2).conj() / snapshots.shape[2]
    power = torch.diagonal(cov, dim1=1, dim2=2).real.mean(1)
    cov = cov / power[:, None, None] + LOADING * torch.eye(SUB, dtype=cov.dtype)
    inv = torch.linalg.inv(cov)
    # a^H inv a is a trigonometric polynomial whose coefficients are sums along the diagonals of inv
    c = torch.stack([torch.diagonal(inv, offset=d, dim1=1, dim2=2).sum(1) for d in range(SUB)], 1)
    c[:, 1:] *= 2
    c = c.to(torch.complex64)
    den = c.real @ COS_LAG - c.imag @ SIN_LAG
    return 0.5 * (torch.log10(power.clamp_min(1e-300)).float()[:, None] - torch.log10(den.clamp_min(1e-6)))


# A reflector's blob has the same phase in all of its cells once the phases of mid-chirp and of an end's middle are taken out. Half an element off
# the middle, so that the angle axis closes: its phase is the same at cos = -1 and cos = 1.
_ROW_PHASE = torch.from_numpy(np.exp(1j * np.pi * (N_R - 1) / N_R * np.arange(N_R)))[:, None]
_COLUMN_PHASE = torch.from_numpy(np.exp(1j * np.pi * 6 * _cosines(COARSE)))[None, :]


def phase_between(maps):
    """Cosine and sine [2, 512, 64] of twice the phase between the two ends' maps, both registered on the polar grid of the array's centre: one
    colour for every cell of a reflector, another for the next reflector. Twice, because side lobes change their sign."""
    ends = []
    for e in range(2):
        smooth = maps[e] * _ROW_PHASE * _COLUMN_PHASE
        # Only the phase is wanted, and f32 holds no more than 38 decades.
        smooth = smooth / (smooth.abs().amax() + 1e-300)
        ends.append(torch.complex(*(_register(part.float(), COARSE, "c", e) for part in (smooth.real, smooth.imag))).to(torch.complex128))
    cross = ends[0] * ends[1].conj()
    cross = (cross / (cross.abs() + 1e-300)) ** 2
    cross = cross.to(torch.complex64)
    return torch.stack([cross.real, cross.imag])


def features(samples):
    """samples [2, 12, 512] complex128 -> fine [4, 512, 256], coarse [10, 512, 64], rows [6, 512], scalars [2], gain (decades)."""
    gain = 0.5 * torch.log10((samples.abs() ** 2).mean() + 1e-300)
    samples = samples / 10**gain
    z = torch.fft.fft(samples * hann(N_R), norm="ortho").transpose(1, 2)  # [2, 512, 12]
    cap = [capon(z[e]) for e in range(2)]
    joint_c = torch.stack([_register(cap[e], FINE, "c", e) for e in range(2)])
    fine = torch.stack([
        joint_c.amin(0),
        joint_c.amax(0),
        torch.minimum(cap[0], _register(cap[1], FINE, 0, 1)),
        torch.minimum(cap[1], _register(cap[0], FINE, 1, 0)),
    ])
    maps = [(z[e] @ BEAMS) for e in range(2)]
    mags = [torch.log10(m.abs() + 1e-20).float() for m in maps]
    coarse = [*mags, *(_register(mags[e], COARSE, "c", e) for e in range(2))]
    for e in range(2):
        step = maps[e] * torch.roll(maps[e], 1, 0).conj()
        step = (step / (step.abs() + 1e-300)).to(torch.complex64)
        coarse += [step.real, step.imag]
    coarse += list(phase_between(maps))
        # local angle: phase step along the elements of the row, an estimate of the mean cosine
    lag = (z[:, :, 1:] * z[:, :, :-1].conj()).sum(2)
    lag = (lag / ((z.abs() ** 2).sum(2) + 1e-300)).to(torch.complex64)
    rows = torch.stack([lag[0].real, lag[0].imag, lag[1].real, lag[1].imag,
                        *(0.5 * torch.log10((z[e].abs() ** 2).mean(1) + 1e-300).float() for e in range(2))])  # [6, 512]
    profile = (z.abs() ** 2).mean((0, 2))
    turns = 2 * math.pi * torch.arange(1, N_R + 1, dtype=torch.float64) * RANGE_BIN / WAVELENGTH
    ulp2 = torch.exp2(2 * (torch.floor(torch.log2(turns)) - 52))
    thesis = 0.5 * torch.log10((profile * ulp2).sum() / profile.sum() / 8)
    harris = _blackman_harris(N_R)
    low = (torch.fft.fft(samples * harris, norm="ortho").abs() ** 2).mean((0, 1)) / (harris**2).mean()
    measured = 0.5 * torch.log10(low.min() + 1e-300)
    return fine, torch.stack(coarse), rows, torch.stack([thesis, measured]).float(), gain


def _blackman_harris(n):
    k = 2 * math.pi * torch.arange(n, dtype=torch.float64) / n
    return 0.35875 - 0.48829 * torch.cos(k) + 0.14128 * torch.cos(2 * k) - 0.01168 * torch.cos(3 * k)


def mirror(samples):
    """The scene reflected in x: the ends swap and their elements reverse."""
    return samples.flip(0, 1)


def mirror_map(image):
    """The same for a map whose last axis is the angle grid."""
    return image.flip(-1).roll(1, -1)
