"""The thesis' encoder-decoder in PyTorch, with the tensor names of its author's program, for parity tests and timing."""
import torch
import torch.nn as nn


def down(cin, cout, kernel):
    conv = nn.Conv2d(cin, cout, kernel, dilation=2, padding=kernel - 1, padding_mode="circular", bias=False)
    return nn.Sequential(conv, nn.BatchNorm2d(cout), nn.ReLU(), nn.MaxPool2d(2))


def up(cin, cout):
    return nn.Sequential(nn.ConvTranspose2d(cin, cout, 4, 2, 1, bias=False), nn.BatchNorm2d(cout), nn.ReLU())


class Towers(nn.Module):
    def __init__(self, filters, levels):
        super().__init__()
        widths = [4] + [filters] * levels
        for k in (3, 5):
            setattr(self, f"layer{k}x{k}", nn.Sequential(*[down(a, b, k) for a, b in zip(widths, widths[1:])]))

    def forward(self, x):
        return torch.cat([self.layer3x3(x), self.layer5x5(x)], 1)


class Decoder(nn.Module):
    def __init__(self, filters, levels):
        super().__init__()
        self.upconv = nn.Sequential(*[up(2 * filters, 2 * filters) for _ in range(levels - 1)], up(2 * filters, 1))

    def forward(self, x):
        return self.upconv(x)


class Thesis(nn.Module):
    def __init__(self, filters=64, levels=5):
        super().__init__()
        self.down = Towers(filters, levels)
        self.up = Decoder(filters, levels)

    def forward(self, x):
        return self.up(self.down(x))
