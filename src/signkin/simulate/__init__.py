"""Simulated corpora with known truth: they test the method and say nothing about people."""
