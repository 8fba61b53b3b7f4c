"""Tags as second libraries read them; each is skipped where its library is not installed."""

from __future__ import annotations

import random

import pytest

from signkin import Interval, read_annotation
from signkin.io.eaf_write import new_eaf

WORDS = ["HAUS", "ÜBER", 'SAY "HI"', "a & b", "c<d>", "IX", "…"]


def tags(seed, tiers=("Gloss", "Other")):
    rng = random.Random(seed)
    out = {}
    for tier in tiers:
        edges = sorted(rng.sample(range(1, 60_000), 40))
        pairs = zip(edges[::2], edges[1::2], strict=True)
        out[tier] = [Interval(a / 1000, b / 1000, rng.choice(WORDS), tier) for a, b in pairs]
    return out


def triples(intervals):
    return [(round(i.start_s, 6), round(i.end_s, 6), i.label) for i in sorted(intervals)]


def read_as_ours(path, tier, **options):
    return triples(i for i in read_annotation(path, **options).intervals if i.tier == tier)


@pytest.mark.parametrize("form", ["long_textgrid", "short_textgrid"])
def test_textgrids_that_praatio_writes(tmp_path, form):
    praatio = pytest.importorskip("praatio.textgrid")
    of_tier = tags(1)
    grid = praatio.Textgrid()
    for tier, own in of_tier.items():
        entries = [(i.start_s, i.end_s, i.label) for i in own]
        grid.addTier(praatio.IntervalTier(tier, entries, 0, 60))
    path = tmp_path / "x.TextGrid"
    grid.save(str(path), format=form, includeBlankSpaces=True)
    for tier, own in of_tier.items():
        assert read_as_ours(path, tier) == triples(own)


def test_real_textgrids_as_praatio_reads_them(real_data):
    praatio = pytest.importorskip("praatio.textgrid")
    folder = real_data / "formats" / "textgrid"
    if not folder.is_dir():
        pytest.skip(f"no folder {folder}")
    compared = 0
    for path in sorted(folder.glob("*.TextGrid")):
        grid = praatio.openTextgrid(str(path), includeEmptyIntervals=False)
        for name in grid.tierNames:
            tier = grid.getTier(name)
            if not isinstance(tier, praatio.IntervalTier):
                continue
            ours = read_as_ours(path, name)
            theirs = [(e.start, e.end, e.label) for e in tier.entries if e.label]
            assert [(a, b) for a, b, _ in ours] == [
                (pytest.approx(a, abs=1e-6), pytest.approx(b, abs=1e-6)) for a, b, _ in theirs
            ]
            # praatio takes white space off both ends, and may keep doubled quotes.
            assert [t.strip().replace('""', '"') for *_, t in ours] == [
                t.strip().replace('""', '"') for *_, t in theirs
            ]
            compared += len(ours)
    assert compared > 10


def test_subtitles_that_srt_and_webvtt_write(tmp_path, real_data):
    from datetime import timedelta

    srt, webvtt = pytest.importorskip("srt"), pytest.importorskip("webvtt")
    own = [i for i in tags(2, ("sign",))["sign"] if "<" not in i.label]
    cues = [
        srt.Subtitle(
            n, timedelta(milliseconds=round(i.start_s * 1000)),
            timedelta(milliseconds=round(i.end_s * 1000)), i.label,
        )
        for n, i in enumerate(own, start=1)
    ]  # fmt: skip
    (tmp_path / "x.srt").write_text(srt.compose(cues), encoding="utf-8")
    assert read_as_ours(tmp_path / "x.srt", "sign") == triples(own)
    webvtt.from_srt(str(tmp_path / "x.srt")).save(str(tmp_path / "x.vtt"))
    assert read_as_ours(tmp_path / "x.vtt", "sign") == triples(own)
    folder = real_data / "formats" / "subtitles"
    if folder.is_dir():
        theirs = list(srt.parse((folder / "test.srt").read_text(encoding="utf-8")))
        assert read_as_ours(folder / "test.srt", "sign") == [
            (c.start.total_seconds(), c.end.total_seconds(), c.content) for c in theirs
        ]


def test_elan_files_as_pympi_reads_them(tmp_path):
    pympi = pytest.importorskip("pympi")
    of_tier = tags(3)
    path = tmp_path / "x.eaf"
    tiers = [(name, None, own) for name, own in of_tier.items()]
    path.write_bytes(
        new_eaf(author="a", date="2020-01-01T00:00:00Z", media_url="v.mp4", tiers=tiers)
    )
    theirs = pympi.Elan.Eaf(str(path))
    for tier, own in of_tier.items():
        found = sorted(theirs.get_annotation_data_for_tier(tier))
        assert [(a / 1000, b / 1000, label) for a, b, label, *_ in found] == triples(own)
        assert read_as_ours(path, tier) == triples(own)


def test_elan_files_that_pympi_writes(tmp_path):
    pympi = pytest.importorskip("pympi")
    own = tags(4, ("Gloss",))["Gloss"]
    theirs = pympi.Elan.Eaf()
    theirs.add_tier("Gloss")
    for i in own:
        theirs.add_annotation("Gloss", round(i.start_s * 1000), round(i.end_s * 1000), i.label)
    theirs.to_file(str(tmp_path / "x.eaf"))
    assert read_as_ours(tmp_path / "x.eaf", "Gloss") == triples(own)
