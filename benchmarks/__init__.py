"""Speed, memory and hits of the Bayesian-binning engine beside its peers, in one run."""
