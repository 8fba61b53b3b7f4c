"""The two papers' methods on the same wrists."""
