"""Write examples/data/: one utterance of the simulated corpus lsf-sim, as BVH and as ELAN.

python -m tools.example_take

Small enough to be kept in the repository: 50 Hz, without the fingers, three decimals.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from signkin.annotation import Interval
from signkin.io.bvh import Hierarchy, write_bvh
from signkin.io.eaf import write_eaf
from signkin.simulate import lsf
from signkin.simulate.body import Body
from tools.simulated import simulate_lsf

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / "examples" / "data"
SIGNS = 6  # of the utterance, at most
STEP = 2  # every second frame of 100 Hz
MARGIN_S = 0.3
FINGERS = re.compile(r"(Thumb|Index|Middle|Ring|Pinky)\d|_end$")


def without_fingers(whole: Hierarchy) -> tuple[Hierarchy, list[int]]:
    """Return the skeleton up to the hands, and the channels of it among those of the whole."""
    kept = [i for i, name in enumerate(whole.joints) if not FINGERS.search(name)]
    first = np.cumsum([0, *(len(c) for c in whole.channels)])
    columns = [j for i in kept for j in range(first[i], first[i + 1])]
    place = {joint: i for i, joint in enumerate(kept)}
    part = Hierarchy(
        joints=tuple(whole.joints[i] for i in kept),
        parents=tuple(place.get(whole.parents[i], -1) for i in kept),
        offsets=whole.offsets[kept],
        channels=tuple(whole.channels[i] for i in kept),
    )
    return part, columns


def main() -> None:
    """Write the two files."""
    recording = simulate_lsf().recordings[0]
    tokens = recording.utterances[0][:SIGNS]
    rate = lsf.RATE_HZ
    first = max(0, tokens[0].start - round(MARGIN_S * rate))
    stop = tokens[-1].end + round(MARGIN_S * rate)
    skeleton, columns = without_fingers(Body().hierarchy)
    DATA.mkdir(parents=True, exist_ok=True)
    motion = DATA / "take.bvh"
    values = recording.values[first:stop:STEP, columns].round(3)
    write_bvh(motion, skeleton, values, rate / STEP)
    short = re.sub(r"(\.\d*?)0+(?=\s)", r"\1", motion.read_text(encoding="ascii"))
    motion.write_text(re.sub(r"\.(?=\s)", ".0", short), encoding="ascii")
    signs = [
        Interval((t.start - first) / rate, (t.end - first) / rate, t.gloss, "gloss") for t in tokens
    ]
    whole = replace(signs[0], end_s=signs[-1].end_s, label="simulated: no meaning", tier="sentence")
    write_eaf(
        DATA / "take.eaf",
        author="signkin simulator",
        date="2017-07-09T00:00:00+00:00",
        media_url="take.bvh",
        tiers=[("sentence", None, [whole]), ("gloss", "sentence", signs)],
    )


if __name__ == "__main__":
    main()
