"""Simulated corpora of any size: to see how a run grows with its recordings."""
