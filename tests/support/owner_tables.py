"""Tables of a corpus as a run writes them, of any size and with any names, for its page."""

import numpy as np
import pandas as pd

from signkin import tables


def frame(kind, rows, unit="m"):
    return pd.DataFrame(rows).reindex(columns=tables.TABLES[kind].names(unit))


def shared(corpus, names, signer=lambda i: f"s{i % 3}"):
    """Return the tables that both studies share, of recordings of these names."""
    lead = [{"corpus": corpus, "recording": n, "signer": signer(i)} for i, n in enumerate(names)]
    about = [
        {**row, "sign": "", "frames": 300, "rate_hz": 50, "duration_s": 6.0 + i % 7, "unit": "m",
         "joints": 8, "orientations": "none", "signs": 4, "clock_offset_s": 0.0,
         "times_interpolated": 0, "tags_left_out": 0, "tags_note": "", "motion_file": "m.csv",
         "annotation_file": "a.csv", "notes": ""}
        for i, row in enumerate(lead)
    ]  # fmt: skip
    gaps = [{**lead[-1], "joint": "right_wrist", "missing_frames": 290, "filled_frames": 0,
             "longest_gap_s": 5.8}]  # fmt: skip
    odd = [{**lead[0], "check": "right forearm", "value": 0.9, "unit": "m", "low": 0.18,
            "high": 0.36, "verdict": "implausible", "note": "too long"}]  # fmt: skip
    return {
        "recordings": frame("recordings", about),
        "gaps": frame("gaps", gaps),
        "plausibility": frame("plausibility", odd),
        "excluded": frame("excluded", []),
    }


def tagged(corpus, names, gloss="A", many=3):
    """Return transitions, boundaries, intervals and Fig. 7's numbers: `many` transitions each."""
    rng = np.random.default_rng(1)
    moves, tags, signs = [], [], []
    for i, name in enumerate(names):
        lead = {"corpus": corpus, "recording": name, "signer": f"s{i % 3}"}
        for k in range(many + 1):
            start, end = 1.0 * k + 0.2, 1.0 * k + 0.7
            signs.append({**lead, "role": "sign", "tier": "t", "label": gloss, "written": gloss,
                          "start_s": start, "end_s": end})  # fmt: skip
            for edge, time in (("start", start), ("end", end)):
                for hand in ("right", "left"):
                    far = float(rng.exponential(0.1))
                    tags.append({**lead, "sign": k + 1, "gloss": gloss, "edge": edge,
                                 "manual_s": time, "hand": hand, "distance_s": far,
                                 "status": "moved" if far < 0.15 else "far"})  # fmt: skip
            if k < many:
                moves.append({**lead, "transition": k + 1, "previous_gloss": gloss,
                              "next_gloss": gloss, "type": "1010", "type_source": "kinematic",
                              "hand": "both", "segmentation": "manual", "start_s": end,
                              "end_s": end + 0.3, "duration_s": 0.3 + 0.01 * (i % 5),
                              "status": "ok", "mean_distance": 0.1 * k})  # fmt: skip
    points = [{**{c: m[c] for c in ("corpus", "recording", "signer", "transition", "type")},
               "mean_distance": m["mean_distance"], "duration_s": m["duration_s"],
               "outlier": False, "in_diamond": True} for m in moves]  # fmt: skip
    return {
        "transitions": frame("transitions", moves),
        "boundaries": frame("boundaries", tags),
        "intervals": frame("intervals", signs),
        "distances": frame("distances", points),
    }
