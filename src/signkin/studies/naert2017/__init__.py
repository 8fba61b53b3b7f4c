"""Naert, Larboulette & Gibet 2017: refinement, transitions, durations, synthesis."""
