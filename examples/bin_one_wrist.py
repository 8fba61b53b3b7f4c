"""Bin one wrist: which polynomial order its path asks for, and where a segment ends.

Endres et al. 2013, section 2.5. data/take.bvh is simulated: it shows the method, no person.
"""

from pathlib import Path

import numpy as np

import signkin
from signkin.binning import Prior, fit
from signkin.kinematics import lowpass

data = Path(__file__).parent / "data"
take = signkin.read_recording(data / "take.bvh", unit="cm", up="y", right="-x")
path = lowpass(take.track("RightHand"), take.rate_hz, cutoff_hz=6)  # (frames, 3), metres

# Two seconds; fit takes what it is given, so the mean is taken off here.
first = round(1.0 * take.rate_hz)
piece = path[first : first + round(2.0 * take.rate_hz)]
found = fit(piece - piece.mean(axis=0), orders=range(6), prior=Prior(noise_sd=0.001))

print(f"{len(piece)} bins of {1000 / take.rate_hz:.0f} ms")
for order in found.orders:
    probability = found.order_probability[order]
    print(f"order {order}: P = {probability:.3f}, {found.map_count(order)} inner boundaries")

best = int(found.orders[np.argmax(found.order_probability)])
ends = take.times_s[first + found.boundaries(best)]
print(f"order {best}: segments end at", ", ".join(f"{end:.2f} s" for end in ends))
