"""Globes of terrane's planets in ParaView: `Globe(folder)` opens the folder of a run."""

from .globe import Globe
from .run import Run, RunError

__all__ = ["Globe", "Run", "RunError"]
