"""Events of C3D files as tags; the files are written, and their events read back, by ezc3d."""

import pytest
import yaml

from signkin import SignkinError, read_annotation
from signkin.io.registry import annotation_formats
from signkin.settings.annotation import OPTIONS
from signkin.settings.annotation import Annotation as Section
from support.c3d_files import write_events as write

EVENTS = (
    ("Sign", "Right", "HAUS", 0.10), ("End", "Right", "", 0.30), ("Sign", "Left", "BAUM", 0.20),
    ("Foot Strike", "Right", "", 0.35), ("End", "Left", "", 61.40), ("Sign", "Right", "", 0.42),
    ("End", "Right", "", 0.52),
)  # fmt: skip


def found(path, **options):
    tags = read_annotation(path, format="c3d_events", **options)
    return [(round(t.start_s, 4), round(t.end_s, 4), t.label, t.tier) for t in tags.intervals]


def test_pairs_of_events_are_signs_on_the_tier_of_their_context(tmp_path):
    path, raw = write(tmp_path / "e.c3d", EVENTS)
    seconds = [round(float(m * 60 + s), 4) for m, s in raw["TIMES"]["value"].T]
    read = found(path, start_event="Sign", end_event="End")
    assert raw["DESCRIPTIONS"]["value"][0] == "HAUS"
    assert sorted(read) == sorted([
        (seconds[0], seconds[1], "HAUS", "Right"), (seconds[2], seconds[4], "BAUM", "Left"),
        (seconds[5], seconds[6], "Sign", "Right"),
    ])  # fmt: skip
    assert found(path, start_event="Sign", end_event="End", tiers="Left") == [
        (0.2, 61.4, "BAUM", "Left")
    ]


def test_labels_are_glosses_until_the_next_event(tmp_path):
    path, _ = write(
        tmp_path / "e.c3d",
        [("HAUS", "Right", "", 0.1), ("rest", "Right", "", 0.3), ("IX", "Right", "", 0.4),
         ("BAUM", "Right", "", 0.5), ("rest", "Right", "", 0.6)],
    )  # fmt: skip
    assert found(path, blank=["rest"]) == [
        (0.1, 0.3, "HAUS", "Right"), (0.4, 0.5, "IX", "Right"), (0.5, 0.6, "BAUM", "Right"),
    ]  # fmt: skip
    with pytest.raises(SignkinError, match=r"event 5, context Right: 'rest' at 0\.600 s has no"):
        found(path)


@pytest.mark.parametrize(
    ("events", "match"),
    [
        (EVENTS[:1], "event 1, context Right: 'Sign' at 0.100 s has no end"),
        (EVENTS[1:2], "event 1, context Right: 'End' at 0.300 s follows no start"),
        ((EVENTS[0], ("Sign", "Right", "", 0.2), EVENTS[1]), "event 2, .* follows a start"),
        ((EVENTS[0], EVENTS[0], EVENTS[1]), "event 2: 'Sign' stands twice at one time"),
        ((), "EVENT: no events in the file"),
    ],
)
def test_events_that_are_no_signs_are_refused(tmp_path, events, match):
    path, _ = write(tmp_path / "e.c3d", events)
    with pytest.raises(SignkinError, match=match):
        found(path, start_event="Sign", end_event="End")


def test_a_file_that_starts_later_says_where_its_events_count_from(tmp_path):
    path, _ = write(tmp_path / "e.c3d", [EVENTS[0], EVENTS[1]], first_frame=5)
    names = {"start_event": "Sign", "end_event": "End"}
    with pytest.raises(SignkinError, match=r"the file starts at frame (\d+), .*event_clock"):
        found(path, **names)
    own = found(path, event_clock="first_frame", **names)
    assert own == [(0.1, 0.3, "HAUS", "Right")]
    shifted = found(path, clock_offset_s=1.0, event_clock="capture", **names)
    assert shifted[0][0] == pytest.approx(1.1 - 5 / 50, abs=1e-6)


def test_options_of_the_model_are_those_of_the_readers():
    from signkin.io import registry
    from signkin.io.collecting import annotation_options

    assert set(OPTIONS) == set(annotation_formats())
    for name, model in OPTIONS.items():
        reader = registry._ANNOTATION[name][0]
        assert set(model.model_fields) == set(annotation_options(reader)), name
    text = "{format: c3d_events, sign_tiers: {right: Right, left: Left}, options: {blank: [rest]}}"
    assert Section.model_validate(yaml.safe_load(text)).options == {"blank": ["rest"]}
