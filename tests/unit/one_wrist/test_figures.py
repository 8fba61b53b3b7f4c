"""The figure of both papers' cuts on one wrist draws what its points say."""

import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.errors import SignkinError
from signkin.figures.style import paper_style
from signkin.studies.one_wrist.analysis import events_of, one_wrist
from signkin.studies.one_wrist.figures import drawn, example_frames
from support.endres import corpus_of, settings
from support.wrists import FOUND_S, MINIMA_S, tables_of_events

OWN = settings(continuous={"bin_s": 0.04, "longest_segment_s": 1.0, "order": 1}).binning.continuous


def frames_of(recording, seconds, unit):
    t = np.arange(0, seconds, 0.02)
    speeds = {f"{h}_speed_{unit}_per_s": 1 + np.sin(5 * t) for h in ("right", "left")}
    return pd.DataFrame({"recording": recording, "time_s": t, **speeds})


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("unit", ["m", "px"])
def test_the_figure_draws_what_the_points_say(unit):
    about, posteriors, found, minima, tags = tables_of_events()
    corpus = corpus_of(["a", "b"], unit=unit)
    events = events_of(found, minima, tags)
    table, rates = one_wrist(corpus, about, posteriors, events, 0.09, 5)
    with paper_style():
        one = drawn(corpus, table, rates, frames_of("a", 4, unit), events, OWN, 0.09)
        one.figure.canvas.draw()
    assert list(one.data.columns) == tables.TABLES["endres_figure"].names()
    speeds, panels = one.figure.axes[:2], one.figure.axes[2:]
    for ax, hand in zip(speeds, ("right", "left"), strict=True):
        assert ax.get_ylabel().startswith(f"{hand} wrist") and f"{unit}/s" in ax.get_ylabel()
        rows = one.data[one.data["panel"] == f"{hand} wrist"]
        dashed = [line.get_xdata()[0] for line in ax.get_lines() if line.get_linestyle() == "--"]
        assert dashed == pytest.approx(FOUND_S["a", hand])  # all: 4 s fit in
        assert dashed == rows.loc[rows["series"] == "boundaries", "x"].tolist()
        curve = rows.loc[rows["series"] == "speed", ["x", "y"]].to_numpy()
        assert np.column_stack(ax.get_lines()[0].get_data()) == pytest.approx(curve)
        dots = np.asarray(ax.collections[0].get_offsets())
        assert dots[:, 0] == pytest.approx(MINIMA_S["a", hand])
        assert dots[:, 1] == pytest.approx(1 + np.sin(5 * dots[:, 0]), abs=0.01)
        assert dots == pytest.approx(rows.loc[rows["series"] == "minima", ["x", "y"]].to_numpy())
        ticks = {line.get_marker(): line for line in ax.get_lines()}
        for kind, marker, n in (("manual tags", "|", 3), ("refined tags", "x", 4)):
            own = rows[rows["series"] == kind]
            assert ticks[marker].get_xdata() == pytest.approx(own["x"].to_numpy())
            assert len(own) == n and (own["y"] > curve[:, 1].max()).all()
    assert speeds[1].get_xlabel() == "time in the recording (s)"
    told = [text.get_text() for text in speeds[0].get_legend().get_texts()]
    assert told == ["boundary (binning)", "speed minimum", "manual tag", "refined tag"]
    assert [ax.get_title(loc="left") for ax in panels] == list(dict.fromkeys(rates["panel"]))
    for ax in panels:
        assert ax.get_xlabel() == "false positives a second"
        rows = one.data[one.data["panel"] == ax.get_title(loc="left")]
        marks = rows[~rows["series"].isin(["chance", "chance low", "chance high", "closed form"])]
        shown = {
            (float(x), float(y))
            for c in ax.containers
            for x, y in zip(*c.lines[0].get_data(), strict=True)
        }
        assert shown == {(row.x, row.y) for row in marks.itertuples()}
    told = one.caption
    assert "nan" not in told and "recording a" in told and "order 1" in told


def test_a_long_recording_is_drawn_in_part():
    about, posteriors, found, minima, _ = tables_of_events()
    corpus = corpus_of(["a", "b"])
    found = pd.concat([found, found.assign(boundary_s=found["boundary_s"] + 10)])
    events = events_of(found, minima, None)
    table, rates = one_wrist(corpus, about, posteriors, events, 0.09, 5)
    with paper_style():
        one = drawn(corpus, table, rates, frames_of("a", 24, "m"), events, OWN, 0.09)
    excerpt = one.data[one.data["panel"].isin(["right wrist", "left wrist"])]
    assert excerpt["x"].between(23.98 / 3, 23.98 / 3 + 6).all()
    right = excerpt.query("panel == 'right wrist' and series == 'boundaries'")
    assert right["x"].tolist() == pytest.approx([t + 10 for t in FOUND_S["a", "right"]])
    told = [text.get_text() for text in one.figure.axes[0].get_legend().get_texts()]
    assert told == ["boundary (binning)", "speed minimum"]


def test_the_longest_recording_with_both_is_drawn(tmp_path):
    about, posteriors, *_ = tables_of_events()
    for name in "ab":
        frames_of(name, 1, "m").to_parquet(tmp_path / f"{name}.parquet")
    paths = [tmp_path / "b.parquet", tmp_path / "a.parquet"]
    assert set(example_frames(paths, about, posteriors)["recording"]) == {"a"}
    assert set(example_frames(paths[:1], about, posteriors)["recording"]) == {"b"}
    with pytest.raises(SignkinError, match="no recording has both a wrist in bins and a speed"):
        example_frames(paths, about, posteriors[:0])
