import pandas as pd

from signkin.pages import corpora as corpora_report
from signkin.pages.speeds import spread


def about(cells):
    return pd.DataFrame(cells, columns=["signer", "sign"])


def test_the_design_is_counted():
    full = about([(g, s) for g in "ab" for s in "xyz" for _ in range(4)])
    assert corpora_report.design(full) == (
        "One sign a recording: 3 signs, made 4 times by each of 2 signers."
    )
    assert corpora_report.design(full[full["signer"] == "a"]).endswith("4 times by one signer.")
    assert "made 3 to 4 times" in corpora_report.design(full.iloc[1:])
    assert corpora_report.design(full.iloc[4:]).endswith("; 1 signs of a signer are lacking.")


def test_panels_are_spread_from_the_first_recording_to_the_last():
    names = [f"r{i}" for i in range(2565)]
    assert spread(names, 4) == ["r0", "r855", "r1709", "r2564"]
    assert spread(names[:2], 4) == ["r0", "r1"]
    assert spread(names[:1], 4) == ["r0"]
