"""What was found in a corpus as a page."""

from __future__ import annotations

from pathlib import Path

import signkin
from signkin.report.page import Page, Section, TableView
from signkin.survey.look import Look

MOST = 40


def look_page(look: Look, folder: Path) -> Page:
    """Return the page of a corpus; folder: where checks.csv and recordings.csv lie."""
    looked = f"{look.read} of {look.total} recordings were read and checked"
    if look.asked < look.total:
        looked += f" ({look.asked} were asked for, evenly over the list)"
    first = look.first or ("Nothing to do: every check is fine.",)
    summary = Section(
        "first", "What to do first", text=(looked + ".",),
        notices=[f"{i + 1}. {line}" for i, line in enumerate(first[:MOST])],
    )  # fmt: skip
    order = {"wrong": 0, "look": 1, "not testable": 2, "fine": 3}
    checks = look.checks.assign(rank=look.checks["level"].map(order))
    checks = checks.sort_values(["rank", "check", "recording"], kind="stable")
    views = (
        TableView(
            label="", title="Recordings", frame=look.recordings,
            caption="What was measured in each; noise_sd from third differences of the wrists, "
            "tempo: half of the power of the faster wrist's velocity lies below it.",
            columns={
                "recording": ("recording", ""), "signer": ("signer", ""),
                "rate_hz": ("rate (Hz)", "g"), "duration_s": ("length (s)", ".2f"),
                "missing_right": ("right wrist missing", ".1%"),
                "missing_left": ("left wrist missing", ".1%"), "tempo_hz": ("tempo (Hz)", ".2f"),
                "noise_sd": ("noise", ".2g"), "signs": ("signs", "d"),
                "clock_offset_s": ("clock offset (s)", "+.2f"), "wrong": ("wrong", "d"),
                "look": ("to look at", "d"),
            },
            file=folder / "recordings.csv", most=MOST,
        ),
        TableView(
            label="", title="Checks", frame=checks,
            caption="Every check of every recording; those that found something go first.",
            columns={
                "recording": ("recording", ""), "check": ("check", ""), "level": ("level", ""),
                "value": ("value", ".4g"), "unit": ("unit", ""), "usual": ("usual", ""),
                "todo": ("what to do", ""),
            },
            file=folder / "checks.csv", most=MOST,
        ),
    )  # fmt: skip
    corpus = look.corpus
    return Page(
        title=f"{corpus.name}: a look before the analysis",
        lead=(f"{corpus.settings['title']}.", "`wrong`: results would be wrong. `look`: it may be "
              "as it should, a person must look."),
        sections=[summary, Section("tables", "What was measured", exhibits=views)],
        version=signkin.__version__,
    )  # fmt: skip
