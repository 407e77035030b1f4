"""Fragilities as the files of other programs."""
