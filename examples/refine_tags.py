"""Refine the tags of one ELAN file to speed minima, for each hand, and write them back.

Naert et al. 2017, sections 4.1 and 4.2. The take is simulated: it shows the method, no person.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import signkin
from signkin.coarticulation import refine
from signkin.io.eaf import NewTier, insert_tiers
from signkin.kinematics import lowpass, speed, speed_minima

data = Path(__file__).parent / "data"
take = signkin.read_recording(data / "take.bvh", unit="cm", up="y", right="-x")
tags = signkin.read_annotation(data / "take.eaf", tiers=("gloss",))
signs = tags.tier("gloss")

print("seconds; * where the tag moved to a speed minimum of the hand")
tiers = []
for hand in ("Right", "Left"):
    path = lowpass(take.track(f"{hand}Hand"), take.rate_hz, cutoff_hz=6)
    minima = speed_minima(speed(path, take.rate_hz), take.rate_hz, prominence=0.05)
    refined, moved, _ = refine(tags.times_s("gloss"), minima, window_s=0.15)
    print(f"\n{hand.lower()} hand  manual         refined")
    for sign, (start, end), (a, b) in zip(signs, refined, moved, strict=True):
        marks = f"{start:.2f}{'*' if a else ' '} {end:.2f}{'*' if b else ' '}"
        print(f"{sign.label:11s} {sign.start_s:.2f}  {sign.end_s:.2f}     {marks}")
    moved_signs = [
        replace(sign, start_s=start, end_s=end)
        for sign, (start, end) in zip(signs, refined.tolist(), strict=True)
    ]
    tiers.append(NewTier(f"gloss refined {hand.lower()}", tuple(moved_signs)))

with TemporaryDirectory() as folder:
    out = Path(folder, "take.eaf")
    out.write_bytes(insert_tiers((data / "take.eaf").read_bytes(), tiers))
    again = signkin.read_annotation(out, tiers=tuple(tier.name for tier in tiers))
    print("\ntiers added:", ", ".join(again.tiers))
