"""Figures: tables and arrays in, drawn on the Axes given; no files but in `style.save`."""
