"""Wear: which pieces come off, how large, what shape, and how the surface settles (thesis, papers B and C)."""

from bem.wear.segmentation import Segmentation, describe_pieces, find_particles, refine_depths, segment

__all__ = ["Segmentation", "describe_pieces", "find_particles", "refine_depths", "segment"]
