"""What the audit's page tells of both papers' cuts on the same wrists."""

import pandas as pd

from signkin.studies.one_wrist.report import two_papers
from signkin.tables import TABLES, write_table


def wrists(path, corpus, rows):
    frame = pd.DataFrame(rows, columns=["found", "truth", "hit_rate", "chance_low", "chance_high"])
    frame = frame.assign(
        corpus=corpus, hand="right", window_s=0.09, hits=1, false_positives_per_s=1.0,
        chance_hit_rate=frame["chance_low"], shifted_hit_rate=0.4, shifted_low=0.3,
        shifted_high=0.6, n_found=5, n_truth=10, recordings=1, note="",
    )  # fmt: skip
    write_table(frame[TABLES["one_wrist"].names()], path, "one_wrist")
    return path


def test_agreement_is_counted_against_chance_and_simulations_apart(tmp_path):
    real = wrists(
        tmp_path / "a.csv", "people",
        [
            ("boundaries", "manual tags", 0.5, 0.2, 0.4), ("minima", "manual tags", 0.9, 0.2, 0.4),
            ("boundaries", "refined tags", 0.4, 0.2, 0.4), ("boundaries", "minima", 0.9, 0.2, 0.4),
        ],
    )  # fmt: skip
    made = wrists(tmp_path / "b.csv", "made", [("boundaries", "manual tags", 0.9, 0.2, 0.4)])
    bare = wrists(tmp_path / "c.csv", "bare", [("boundaries", "minima", 0.9, 0.2, 0.4)])
    kinds = {"people": False, "made": True, "bare": False}
    section = two_papers({"people": real, "made": made, "bare": bare}, kinds)
    told = section.text[1]
    assert "On real recordings, manual tags are hit above chance on 1 of 1 wrists" in told
    assert "refined tags are hit above chance on 0 of 1 wrists" in told  # as high as chance
    assert "On simulated recordings, manual tags are hit above chance on 1 of 1 wrists" in told
    frame = section.exhibits[0].frame
    assert frame["above"].tolist() == ["yes", "yes", "no", "yes"]
    assert frame["above_shifted"].tolist() == ["no", "yes", "no", "yes"]
    assert "on 1 of 1 wrists (0 where the boundaries themselves are shifted)" in told
    assert not frame["truth"].eq("minima").any()
    assert two_papers({"bare": bare}, kinds) is None
    assert two_papers({}, kinds) is None
