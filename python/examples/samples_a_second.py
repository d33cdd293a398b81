"""Samples a second of `apertura.torch.Scenes`, beside the bare simulator: `python samples_a_second.py [--count N] [--workers 0,2] [--rounds N]`.

The bare simulator makes the samples of all elements and nothing else. The dataset adds both ends' features, the map of the whole array, and the tensors
of batches of four. Rounds alternate between them; printed are medians over rounds. Starting the workers counts. Needs PyTorch; measure on a machine that
does nothing else.
"""
import argparse
import statistics
import time

import torch

import apertura as ap

MIXTURE = "1=4,2=12,3=14,clusters=9,walls=12,crowd=15"


def rate(count, work):
    began = time.perf_counter()
    work()
    return count / (time.perf_counter() - began)


def simulate(count, kinds):
    for index in range(count):
        ap.Scene.random(kinds[index % len(kinds)], 1, index // len(kinds), purpose="training").simulate()


def loaded(data, count, workers):
    loader = torch.utils.data.DataLoader(torch.utils.data.Subset(data, range(count)), batch_size=4, num_workers=workers)
    for _ in loader:
        pass


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int, default=200, help="samples of a round")
    parser.add_argument("--workers", default="0,2")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    data = ap.torch.Scenes(MIXTURE, 1, targets=["measured"])
    # The scenes of the dataset, so that both do the same work.
    kinds = [data.arrays(index)["kind"] for index in range(64)]
    work = {"bare simulator": lambda: simulate(given.count, kinds)}
    for workers in map(int, given.workers.split(",")):
        work[f"dataset, {workers} workers"] = lambda workers=workers: loaded(data, given.count, workers)
    rounds = [{name: rate(given.count, run) for name, run in work.items()} for _ in range(given.rounds)]
    for name in work:
        found = statistics.median(found[name] for found in rounds)
        ratio = statistics.median(found[name] / found["bare simulator"] for found in rounds)
        print(f"{name}: {found:.1f} samples a second, {ratio:.2f} of the bare simulator")


if __name__ == "__main__":
    main()
