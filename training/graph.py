"""A training step as a CUDA graph: recorded once and replayed for every batch.

Python starts the kernels of a step one by one, which takes longer than a fast GPU needs to run them. A graph starts them all at once."""
import torch

#: Steps that are taken before the recording: libraries choose their kernels and take their memory in these.
FIRST = 5


class Replayed:
    """Calls `step` with a batch, at first as it is and then from a recording.

    `step` takes a dict of tensors and returns the loss as a tensor. What else changes from one step to the next must be a tensor on the GPU that is
    filled before the call. The batches have the same shapes."""

    def __init__(self, step):
        self.step, self.calls = step, 0
        self.batch, self.loss, self.graph = None, None, torch.cuda.CUDAGraph()
        self.stream = torch.cuda.Stream()

    def __call__(self, batch):
        if self.batch is None:
            self.batch = {name: tensor.clone() for name, tensor in batch.items()}
        for name, tensor in self.batch.items():
            tensor.copy_(batch[name])
        self.calls += 1
        if self.calls <= FIRST:
            return self._on_a_stream_beside()
        if self.loss is None:
            self._record()
        self.graph.replay()
        return self.loss.clone()

    def _on_a_stream_beside(self):
        """What a recording keeps must not belong to the stream that everything else runs on."""
        self.stream.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(self.stream):
            loss = self.step(self.batch)
        torch.cuda.current_stream().wait_stream(self.stream)
        return loss

    def _record(self):
        # Other threads copy scenes to the GPU meanwhile.
        with torch.cuda.graph(self.graph, stream=self.stream, capture_error_mode="thread_local"):
            self.loss = self.step(self.batch)
