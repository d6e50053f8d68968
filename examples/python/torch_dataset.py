"""Loops made on the fly by the workers of a torch DataLoader."""

from typing import Any, Tuple

import torch
from torch.utils.data import DataLoader, Dataset

import echocine


class Hearts(Dataset[Tuple[Any, float]]):
    """Pictures (T, H, W) and ejection fractions. Nothing is computed before a worker asks."""

    def __len__(self) -> int:
        return 4

    def __getitem__(self, index: int) -> Tuple[Any, float]:
        ef = 0.3 + 0.1 * index
        scene = echocine.heart(ef=ef, keyframes=6, threads=1)
        scene.update({"probe.lines": 32, "probe.samples": 96, "output.width": 112, "output.height": 112, "acquisition.frame_rate_hz": 5})
        return torch.from_numpy(echocine.render(scene, threads=1).images.copy()), ef


if __name__ == "__main__":
    for pictures, ef in DataLoader(Hearts(), batch_size=2, num_workers=2):
        print(tuple(pictures.shape), ef)
