"""Naert et al. 2017, 3.1 and 5.2: synthetic transitions and utterances."""
