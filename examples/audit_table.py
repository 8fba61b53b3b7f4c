"""Audit a printed table: can these means and SDs be right, and what follows from them?

data/table.csv is made up: pauses in ms of two groups, taken from video at 25 frames a second, so
that every value is a multiple of 40 ms. Numbers are read as text: trailing zeros count.
"""

import csv
from pathlib import Path

from signkin.audit import anova_from_summary, grim, grimmer

with (Path(__file__).parent / "data" / "table.csv").open(newline="", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))

for row in rows:
    mean = grim(row["mean"], row["n"], grain="40")
    print(f"{row['group']:9s} mean {row['mean']}: {mean.verdict}: {mean.why}")
    if mean.sums:
        sd = grimmer(row["mean"], row["sd"], row["n"], grain="40")
        print(f"{row['group']:9s} SD {row['sd']}: {sd.verdict}: {sd.why}")

fine = [row for row in rows if row["group"] != "learners"]
test = anova_from_summary(*([row[key] for row in fine] for key in ("n", "mean", "sd")))
f, p = test.statistic, test.p
print(f"\n{' and '.join(row['group'] for row in fine)}, {test.name}:")
print(f"F(1, {test.df2.value:.0f}) = {f.value:.3f}, by rounding {f.low:.3f} to {f.high:.3f}")
print(f"p = {p.value:.3f}, by rounding {p.low:.3f} to {p.high:.3f}")
