"""Scenes kept on the GPU, each drawn several times: for a GPU that trains faster than the processors beside it make scenes."""
import queue
import random
import threading

import torch

#: Threads that ask for scenes. Each call makes its scenes on all processors; a second call fills the gap while the first hands over.
MAKERS = 3
#: Scenes of one call.
CHUNK = 32


class Pool:
    """An endless iterator of batches.

    The last `size` scenes stay on `device`, large tensors as 16-bit floats. A batch is drawn from them at random. On average a scene is drawn
    `uses` times at most: the iterator waits for new scenes where training is faster. Scenes of which `wanted` is False are not kept.
    """

    def __init__(self, data, first, batch, device, size, uses, seed, wanted=None):
        self.first, self.batch, self.device, self.size, self.uses = first, batch, device, size, uses
        self.arrived, self.used, self.kept, self.wanted, self.made_until = 0, 0, {}, wanted, first
        self.random = random.Random(seed)
        self.made = queue.Queue(maxsize=2 * MAKERS)
        self.on_gpu = device.type == "cuda"
        self.numbers, self.lock = iter(range(first, len(data), CHUNK)), threading.Lock()
        self.is_over = False
        self.makers = [threading.Thread(target=self._make, args=(data,), daemon=True) for _ in range(MAKERS)]
        for maker in self.makers:
            maker.start()

    @property
    def drawn(self):
        """Number of the first scene that no batch can hold."""
        return self.made_until

    def _make(self, data):
        """Makes scenes until `close`. An error ends the thread, and reaches `__next__`."""
        # On a stream of its own a copy to the GPU doesn't wait for the training.
        stream = torch.cuda.Stream(self.device) if self.on_gpu else None
        try:
            while not self.is_over:
                with self.lock:
                    start = next(self.numbers)
                examples = data.__getitems__(range(start, start + CHUNK))
                with torch.cuda.stream(stream):
                    scenes = [self._moved(example) for example in examples if self.wanted is None or self.wanted(example)]
                if stream:
                    stream.synchronize()
                self.made.put((start, scenes))
        except Exception as error:  # any exception must end the training
            self.made.put((None, error))

    def _moved(self, example):
        moved = {name: t.to(self.device) for name, t in example.items() if name != "ends"}
        return {name: t.half() if t.ndim > 1 else t for name, t in moved.items()}

    def _keep(self, scenes):
        for scene in scenes:
            place = self.arrived % self.size
            for name, tensor in scene.items():
                if name not in self.kept:
                    self.kept[name] = tensor.new_empty(self.size, *tensor.shape)
                self.kept[name][place] = tensor
                if self.on_gpu:
                    tensor.record_stream(torch.cuda.current_stream())  # its memory is free once this stream has read it
            self.arrived += 1

    def close(self):
        """Ends the threads: one that computes while Python ends would abort the program."""
        self.is_over = True
        while any(maker.is_alive() for maker in self.makers):
            try:
                self.made.get(timeout=0.1)
            except queue.Empty:
                pass

    def __iter__(self):
        return self

    def __next__(self):
        # Beside a GPU the processors have nothing else to do; on processors the threads wait, or they take the time of the training.
        takes_all = self.on_gpu and not self.made.empty()
        while takes_all or self.arrived < self.batch or self.used + self.batch > self.uses * self.arrived:
            start, scenes = self.made.get()
            if start is None:
                raise scenes
            self._keep(scenes)
            self.made_until = max(self.made_until, start + CHUNK)
            takes_all = self.on_gpu and not self.made.empty()
        self.used += self.batch
        places = torch.tensor(self.random.sample(range(min(self.arrived, self.size)), self.batch))
        if self.on_gpu:
            places = places.pin_memory().to(self.device, non_blocking=True)  # without pinned memory the copy would wait for the training
        return {name: kept[places].float() for name, kept in self.kept.items()}
