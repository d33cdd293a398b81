"""A network in PyTorch as a method: `apertura --method-command "python own_pytorch.py weights.pt"`.

It looks at the maps of both ends, one above the other, and draws the map of the whole array. Without a file its weights are random.
"""
import hashlib
import sys

import torch

import apertura as ap


class Network(torch.nn.Module):
    def __init__(self, channels=16):
        super().__init__()
        wide = {"kernel_size": (5, 9), "padding": (2, 4), "padding_mode": "circular"}
        self.layers = torch.nn.Sequential(
            torch.nn.Conv2d(2, channels, **wide), torch.nn.ReLU(), torch.nn.Conv2d(channels, 1, **wide), torch.nn.Sigmoid()
        )

    def forward(self, ends):
        """`ends`, complex `[2, elements of an end, samples]`, to Lambda `[samples, columns]`."""
        window = torch.hann_window(ends.shape[1], periodic=False)[:, None] * torch.hann_window(ends.shape[2], periodic=False)
        maps = torch.fft.fft2(ends * window, s=(self.columns, ends.shape[2]), dim=(1, 2)).abs().log10().clamp(min=-20)
        maps = torch.fft.fftshift(maps, dim=1).transpose(1, 2).float()
        low, high = maps.amin((1, 2), keepdim=True), maps.amax((1, 2), keepdim=True)
        return self.layers(((maps - low) / (high - low))[None])[0, 0]


def method(network):
    @torch.no_grad()
    def reconstruct(ends, radar):
        network.columns = radar.elements
        return network(torch.from_numpy(ends))

    return reconstruct


def loaded(path=None):
    """The network and digits that tell its weights from others."""
    torch.manual_seed(0)
    network = Network().eval()
    if path is None:
        return network, ""
    network.load_state_dict(torch.load(path, weights_only=True))
    with open(path, "rb") as file:
        return network, hashlib.file_digest(file, "sha256").hexdigest()[:12]


if __name__ == "__main__":
    network, weights = loaded(*sys.argv[1:])
    ap.serve(method(network), name="own-pytorch", description="two convolutions on the maps of both ends", weights=weights)
