"""Endres, Meirovitch, Flash & Giese 2013: Bayesian binning of single signs."""
