"""Segments by binning as tiers of ELAN files."""

from itertools import pairwise

import pandas as pd
import pympi
import pytest

from signkin import tables
from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.eaf import write_eaf
from signkin.studies.one_wrist.elan import copies, tiers
from support.wrists import FOUND_S, tables_of_events


def test_segments_come_back_from_elan(tmp_path):
    write_eaf(
        tmp_path / "a.eaf", author="t", date="2020", media_url="v.mp4",
        tiers=[("Gloss", None, [Interval(1, 2, "A", "Gloss"), Interval(3, 4, "B", "Gloss")])],
    )  # fmt: skip
    about = pd.DataFrame(
        {
            "recording": ["a"], "annotation_file": ["a.eaf"], "clock_offset_s": [0.25],
            "motion_file": ["a.bvh"],
        }
    )  # fmt: skip
    tags = tables.empty("intervals")
    _, _, found, _, _ = tables_of_events()
    made = copies(tmp_path, about, found, tags)
    assert list(made) == ["a.eaf"]
    (tmp_path / "new.eaf").write_bytes(made["a.eaf"])
    back = pympi.Elan.Eaf(str(tmp_path / "new.eaf"))
    assert {n for n in back.get_tier_names() if n.startswith("signkin")} == {
        "signkin binning right", "signkin binning left",
    }  # fmt: skip
    segments = back.get_annotation_data_for_tier("signkin binning right")
    # The file's clock runs 0.25 s behind the recording's.
    times = [round(1000 * (t - 0.25)) for t in FOUND_S["a", "right"]]
    assert [(a, b) for a, b, *_ in sorted(segments)] == list(pairwise(times))
    assert [label for _, _, label, *_ in sorted(segments)] == ["1", "2", "3"]
    assert not back.get_annotation_data_for_tier("signkin binning left")  # one boundary: no segment
    assert len(back.get_annotation_data_for_tier("Gloss")) == 2
    assert tiers(found, "nobody")[0].intervals == ()
    (tmp_path / "a.eaf").write_text("no ELAN")
    with pytest.raises(SignkinError, match=r"a\.eaf"):
        copies(tmp_path, about, found, tags)
