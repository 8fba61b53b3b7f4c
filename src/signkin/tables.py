"""The tables that the pipeline writes: their columns, units and meaning, in one place.

`docs/data-dictionary.md` is made from this module (`python -m signkin.tables`),
and a table whose columns differ from it is not written. A `{u}` in a column's
name stands for the corpus's unit of length, m or px.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from signkin.errors import SignkinError, listed

LENGTH_UNITS = ("m", "px")


@dataclass(frozen=True)
class Column:
    """One column: name, unit (empty where it has none), meaning."""

    name: str
    unit: str
    meaning: str
    text: bool = False


@dataclass(frozen=True)
class Table:
    """One kind of table: where it lies, what a row is, its columns."""

    name: str
    path: str
    row: str
    columns: tuple[Column, ...]

    def names(self, unit: str = "m") -> list[str]:
        """Return the column names for a corpus in metres or pixels."""
        return [column.name.format(u=unit) for column in self.columns]


def _text(name: str, meaning: str) -> Column:
    return Column(name, "", meaning, text=True)


_LEAD = (
    _text("corpus", "corpus, as its folder is called"),
    _text("recording", "recording, one take"),
    _text("signer", "signer, as recordings.csv names them"),
)
_HAND = _text("hand", "right or left, the signer's own")
_SIGN = Column("sign", "", "place of the sign in its recording, from 1, in order of start")
_EDGE = _text("edge", "start or end of the sign")
_NOTE = _text("note", "why a value is missing or special")

TABLES: dict[str, Table] = {
    table.name: table
    for table in (
        Table(
            "recordings",
            "results/<corpus>/recordings.csv",
            "a recording that was read",
            (
                *_LEAD,
                Column("frames", "", "number of frames"),
                Column("rate_hz", "Hz", "frames a second"),
                Column("duration_s", "s", "frames / rate"),
                _text("unit", "unit of length: m or px"),
                Column("joints", "", "number of joints"),
                _text("orientations", "recorded, limb_frames (made from positions) or none"),
                Column("signs", "", "tagged signs"),
                Column("clock_offset_s", "s", "added to the annotation's times (TIME_ORIGIN)"),
                Column("times_interpolated", "", "open times of the annotation, interpolated"),
                _text("motion_file", "file of the motion, in the corpus's data folder"),
                _text("annotation_file", "file of the annotation"),
            ),
        ),
        Table(
            "excluded",
            "results/<corpus>/excluded.csv",
            "a recording that was left out because the corpus says `on_error: skip`",
            (*_LEAD, _text("stage", "where it failed"), _text("reason", "the error's sentence")),
        ),
        Table(
            "intervals",
            "results/<corpus>/intervals.csv",
            "a tagged interval",
            (
                *_LEAD,
                _text("role", "sign, utterance or translation"),
                _text("tier", "tier of the annotation"),
                _text("label", "gloss, or the text of the utterance"),
                Column("start_s", "s", "start, from the recording's start"),
                Column("end_s", "s", "end"),
            ),
        ),
        Table(
            "gaps",
            "results/<corpus>/gaps.csv",
            "a joint of a recording that has gaps",
            (
                *_LEAD,
                _text("joint", "joint"),
                Column("missing_frames", "", "frames without a position"),
                Column("filled_frames", "", "of these, filled (gap no longer than longest_gap_s)"),
                Column("longest_gap_s", "s", "longest gap"),
            ),
        ),
        Table(
            "minima",
            "results/<corpus>/minima.csv",
            "a local minimum of a wrist's speed (Naert et al. 2017, section 4.1)",
            (
                *_LEAD,
                _HAND,
                Column("minimum_s", "s", "time of the minimum"),
                Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed at the minimum"),
                Column("prominence_{u}_per_s", "m/s or px/s", "depth below its surroundings"),
            ),
        ),
        Table(
            "plausibility",
            "results/<corpus>/plausibility.csv",
            "a check of a recording's rate and unit against what a body can do",
            (
                *_LEAD,
                _text("check", "what was measured"),
                Column("value", "see unit", "measured value"),
                _text("unit", "its unit"),
                Column("low", "see unit", "lowest plausible value"),
                Column("high", "see unit", "highest plausible value"),
                _text("verdict", "plausible, implausible or not testable"),
                _NOTE,
            ),
        ),
        Table(
            "boundaries",
            "results/naert2017/<corpus>/boundaries.csv",
            "a tag (an edge of a sign) for one hand, before and after refinement "
            "(Naert et al. 2017, section 4.2)",
            (
                *_LEAD,
                _SIGN,
                _text("gloss", "label of the sign"),
                _EDGE,
                Column("manual_s", "s", "time of the manual tag"),
                _HAND,
                Column("minimum_s", "s", "speed minimum of this hand nearest to the tag"),
                Column("refined_s", "s", "time after refinement"),
                Column("moved", "", "whether the tag was moved to a minimum"),
                Column("distance_s", "s", "from the tag to the nearest minimum"),
                _text("status", "moved, far (no minimum in the window) or taken (see note)"),
                _NOTE,
            ),
        ),
        Table(
            "transitions",
            "results/naert2017/<corpus>/transitions.csv",
            "a transition between two signs of one utterance, for one segmentation and hand "
            "(Naert et al. 2017, section 5.1)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("previous_gloss", "sign before"),
                _text("next_gloss", "sign after"),
                _text(
                    "type",
                    "four digits: hands and symmetry of the sign before, then of the sign after "
                    "(hands: 0 one, 1 two, 2 one with the other keeping the context)",
                ),
                _text("type_source", "lexicon (signs.csv) or kinematic (inferred from motion)"),
                _text("hand", "both (whole body), right or left (arm joints of that hand)"),
                _text("segmentation", "manual or refined"),
                _text("utterance", "utterance the transition belongs to"),
                Column("start_s", "s", "end of the sign before"),
                Column("end_s", "s", "start of the sign after"),
                Column("duration_s", "s", "end - start; below 0 where the signs overlap"),
                _text("status", "ok, zero_length or overlap"),
                Column("geodesic_rad", "rad", "eq. 1, mean over joints of half the rotation angle"),
                Column("euclidean_{u}", "m or px", "eq. 2, mean over joints"),
                Column("n_joints", "", "joints in the Euclidean mean (gaps left out)"),
                Column("geodesic_norm", "", "geodesic, mean taken off, divided by the range"),
                Column("euclidean_norm", "", "Euclidean, mean taken off, divided by the range"),
                Column("mean_distance", "", "mean of the two (of the one, where one is missing)"),
                _NOTE,
            ),
        ),
        Table(
            "sign_types",
            "results/naert2017/<corpus>/sign_types.csv",
            "a sign's type from the lexicon and from motion",
            (
                *_LEAD,
                _SIGN,
                _text("gloss", "label of the sign"),
                Column("start_s", "s", "start of the sign"),
                Column("end_s", "s", "end of the sign"),
                _text("utterance", "utterance the sign belongs to, empty for none"),
                _text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
                _text("kinematic", "two digits from motion"),
                _text("type", "the two digits in use"),
                _text("type_source", "lexicon or kinematic"),
                Column("activity", "", "path of the stiller wrist / path of the busier one"),
                Column("mirror", "", "correlation of the wrists' velocities, one mirrored"),
                Column(
                    "held_shift", "", "shift of the still wrist since the sign before, in reaches"
                ),
                _NOTE,
            ),
        ),
        Table(
            "lexicon",
            "results/naert2017/<corpus>/lexicon.csv",
            "a gloss of signs.csv or of the annotation",
            (
                _text("corpus", "corpus"),
                _text("gloss", "gloss"),
                _text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
                Column("occurrences", "", "signs with this gloss in the corpus"),
                _NOTE,
            ),
        ),
        Table(
            "table1",
            "results/naert2017/<corpus>/table1.csv",
            "an utterance (Naert et al. 2017, Table 1)",
            (
                *_LEAD,
                _text("utterance", "utterance"),
                Column("start_s", "s", "start"),
                Column("end_s", "s", "end"),
                Column("signs", "", "number of signs"),
                _text("glosses", "the signs in order"),
                _text("translation", "translation, where the corpus has one"),
            ),
        ),
        Table(
            "table2",
            "results/naert2017/<corpus>/table2.csv",
            "a transition type (Naert et al. 2017, Table 2), or `all`",
            (
                _text("corpus", "corpus"),
                _text("type", "four digits, or all"),
                Column("n", "", "transitions"),
                Column("mean_s", "s", "mean duration"),
                Column("sd_s", "s", "standard deviation, divisor n - 1"),
                Column("n_without_outlier", "", "transitions that are no outliers"),
                Column("mean_without_outlier_s", "s", "their mean"),
                Column("sd_without_outlier_s", "s", "their standard deviation"),
                _text("printed_n", "number as the paper would print it; (without outliers)"),
                _text("printed_mean", "mean so printed, rounded half up"),
                _text("printed_sd", "standard deviation so printed"),
                _text("published_n", "number in Naert et al. 2017, Table 2"),
                _text("published_mean", "mean there"),
                _text("published_sd", "standard deviation there"),
                _text("equal", "yes or no: whether printed and published agree in every digit"),
                _NOTE,
            ),
        ),
        Table(
            "fig10",
            "results/naert2017/<corpus>/fig10.csv",
            "a change in the number of hands (Naert et al. 2017, Fig. 10; type 2 is two-handed)",
            (
                _text("corpus", "corpus"),
                _text("change", "1H to 1H, 1H to 2H, 2H to 1H or 2H to 2H"),
                Column("n", "", "transitions"),
                Column("mean_s", "s", "mean duration"),
                Column("sd_s", "s", "standard deviation, divisor n - 1"),
                Column("published_n", "", "transitions, summed from the paper's Table 2"),
                Column("published_mean_s", "s", "mean that follows from the paper's Table 2"),
            ),
        ),
        Table(
            "diamond",
            "results/naert2017/<corpus>/diamond.csv",
            "a corner of the diamond of Fig. 8",
            (
                _text("corpus", "corpus"),
                _text("corner", "left, top, right or bottom"),
                Column("mean_distance", "", "average normalised distance at the corner"),
                Column("duration_s", "s", "duration at the corner"),
                Column("share_inside", "", "share of the transitions that the diamond holds"),
                Column("n", "", "transitions"),
            ),
        ),
        Table(
            "excerpt",
            "results/naert2017/<corpus>/fig04.csv, fig05.csv, fig06.csv",
            "a point of a speed figure (Naert et al. 2017, Fig. 4-6)",
            (
                _text("corpus", "corpus"),
                _text("recording", "recording the excerpt is taken from"),
                _text("kind", "speed, tag, minimum or refined"),
                _text("hand", "right or left; both for tags"),
                _text("edge", "start or end of a sign, for tags and refined tags"),
                _text("gloss", "sign the tag belongs to"),
                _text("status", "moved, far or taken, for refined tags (see boundaries)"),
                Column("time_s", "s", "time in the recording"),
                Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed of the wrist"),
            ),
        ),
        Table(
            "distances",
            "results/naert2017/<corpus>/fig07.csv, fig08.csv",
            "a transition between manual tags, overlapping signs left out (Fig. 7, 8)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("type", "four digits"),
                Column("mean_distance", "", "average of the two normalised distances"),
                Column("duration_s", "s", "duration"),
                Column("outlier", "", "whether the outlier rule marks it"),
                Column("in_diamond", "", "whether the diamond of Fig. 8 holds it"),
            ),
        ),
        Table(
            "segmentations",
            "results/naert2017/<corpus>/fig09.csv",
            "a transition of one hand with manual and with refined tags (Fig. 9)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _HAND,
                Column("manual_euclidean_{u}", "m or px", "distance of the arm's joints"),
                Column("manual_duration_s", "s", "duration between manual tags"),
                Column("refined_euclidean_{u}", "m or px", "distance, refined tags"),
                Column("refined_duration_s", "s", "duration between refined tags"),
            ),
        ),
        Table(
            "refinement",
            "results/naert2017/<corpus>/refinement.csv",
            "a measure of how the tags lie to the speed minima, per hand, against chance",
            (
                _text("corpus", "corpus"),
                _HAND,
                _text("measure", "what is measured"),
                Column("value", "see unit", "for the manual tags"),
                _text("unit", "its unit"),
                Column("chance", "see unit", "mean over sets of tags placed at random"),
                Column("chance_low", "see unit", "2.5 % quantile over these sets"),
                Column("chance_high", "see unit", "97.5 % quantile"),
                Column("n", "", "tags (or pairs of tags)"),
                _NOTE,
            ),
        ),
        Table(
            "truth_error",
            "results/naert2017/<corpus>/truth_error.csv",
            "the error of the tags of one hand to the known truth (simulated corpora)",
            (
                _text("corpus", "corpus"),
                _HAND,
                _text("segmentation", "manual or refined"),
                Column("n", "", "tags with a known truth"),
                Column("mean_error_s", "s", "mean absolute error"),
                Column("low_s", "s", "2.5 % bootstrap quantile of the mean"),
                Column("high_s", "s", "97.5 % bootstrap quantile"),
                Column("median_error_s", "s", "median absolute error"),
                Column("within_20ms", "", "share of tags within 0.02 s of the truth"),
            ),
        ),
        Table(
            "surface",
            "results/naert2017/<corpus>/surface.csv",
            "a coefficient of the duration surface (Naert et al. 2017, section 5.2, eq. 4)",
            (
                _text("corpus", "corpus"),
                _text("coefficient", "constant, geodesic or euclidean"),
                _text("published", "theta as printed"),
                Column("fitted", "s, s/rad, s/unit", "least squares on the manual transitions"),
                Column("low", "same", "95 % interval, low"),
                Column("high", "same", "95 % interval, high"),
                Column("designed", "same", "fit on the distances a simulation was designed with"),
                Column("shift_percent", "%", "fitted against published"),
                Column("n", "", "transitions"),
                Column("mean_error_s", "s", "eq. 5 of the fit"),
            ),
        ),
        Table(
            "overview",
            "results/naert2017/fig03.csv",
            "a rule of the workflow (the counterpart of Naert et al. 2017, Fig. 3)",
            (
                _text("rule", "rule; `from>to:column` is an arrow that passes a column"),
                _text("stage", "file in workflow/rules it stands in"),
                _text("note", "what it does"),
                Column(
                    "column",
                    "",
                    "place from left to right: as far right as the rules after it allow",
                ),
                Column("row", "", "place among the rules of its column"),
                _text("after", "rules whose output it takes, those behind others left out"),
            ),
        ),
        Table(
            "truth",
            "the corpus's own folder (truth_file in corpus.yaml)",
            "a true boundary of one hand (simulated corpora)",
            (_text("recording", "recording"), _SIGN, _EDGE, _HAND, Column("true_s", "s", "time")),
        ),
        Table(
            "design",
            "results/<corpus>/simulated/design.csv",
            "a transition as the simulator designed it",
            (
                _text("recording", "recording"),
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("type", "four digits"),
                Column("duration_s", "s", "duration between the manual tags"),
                Column("geodesic_rad", "rad", "distance between the postures at the true tags"),
                Column("euclidean_m", "m", "distance between the postures at the true tags"),
            ),
        ),
    )
}


# --- the audit -------------------------------------------------------------------------------

_CLAIM = (
    _text("paper", "folder of the paper below papers/"),
    _text("id", "claim, as papers/<paper>/claims.yaml names it"),
    _text("location", "section, table or figure of the paper"),
    _text("evidence", "published numbers, or a corpus"),
    _text("evidence_kind", "published numbers, simulated (a test of the method) or real"),
)
for _table in (
    Table(
        "claims",
        "results/audit/claims.csv",
        "a claim of a paper on one piece of evidence",
        (
            *_CLAIM,
            _text("claim", "what is claimed, in our words"),
            _text("printed", "the numbers as printed"),
            _text("recomputed", "the numbers recomputed"),
            _text("interval", "what rounding allows them to be; on a corpus, 95 % by bootstrap"),
            _text(
                "verdict",
                "consistent or inconsistent (published numbers), holds or fails (corpora), or "
                "not testable",
            ),
            _text("note", "why, or what is missing"),
            _text("source", "tables behind it"),
        ),
    ),
    Table(
        "checks",
        "results/audit/checks.csv",
        "a finding of a check",
        (
            *_CLAIM,
            _text("check", "check, as the claim names it"),
            _text("item", "row of the printed table that the finding is about"),
            _text("reads", "how the claim is read"),
            _text("printed", "as printed"),
            _text("recomputed", "recomputed"),
            _text("interval", "what rounding allows; on a corpus, 95 % by bootstrap"),
            _text("verdict", "consistent, inconsistent, undecidable; holds, fails; not testable"),
            _text("why", "one sentence"),
            _text("source", "table behind it"),
        ),
    ),
    Table(
        "multiverse",
        "results/naert2017/<corpus>/multiverse.csv",
        "a claim under one specification: a combination of choices that the paper leaves open",
        (
            _text("corpus", "corpus"),
            _text("claim", "claim of Naert et al. 2017"),
            _text("segmentation", "manual or refined tags"),
            _text("hand", "right, left or both"),
            Column("cutoff_hz", "Hz", "low-pass, half gain; empty where it plays no part"),
            Column("prominence", "", "least depth of a minimum; empty where it plays no part"),
            Column("window_s", "s", "refinement window; empty where it plays no part"),
            _text("outliers", "kept or left out; empty where it plays no part"),
            _text("statistic", "what the estimate is"),
            Column("estimate", "see statistic", "the number the claim is about"),
            Column("bound", "see statistic", "what it is set against"),
            Column("holds", "", "whether the claim holds so"),
            Column("n", "", "transitions or tags"),
            _NOTE,
        ),
    ),
    Table(
        "specifications",
        "results/audit/<claim>_specifications.csv",
        "a level of a choice in the specification curve of a claim, or `all`",
        (
            _text("paper", "folder of the paper below papers/"),
            _text("claim", "claim"),
            _text("corpus", "corpus"),
            _text("choice", "choice that the paper leaves open, or all"),
            _text("level", "its value"),
            Column("specifications", "", "combinations of choices with this level"),
            Column("holding", "", "of these, where the claim holds"),
            Column("share", "", "holding over specifications"),
            Column("median_estimate", "see the curve", "median of the estimates"),
            Column(
                "share_decided",
                "",
                "share of the variance of holds (yes 1, no 0) that lies between the levels of "
                "this choice; the largest decides",
            ),
            _NOTE,
        ),
    ),
):
    TABLES[_table.name] = _table


_NOT_YET = ("geodesic_norm", "euclidean_norm", "mean_distance", "note")
TABLES["raw_transitions"] = Table(
    "raw_transitions",
    "results/naert2017/<corpus>/shards/<shard>/transitions.csv",
    "a transition before distances are normalised, which wants the whole corpus",
    tuple(c for c in TABLES["transitions"].columns if c.name not in _NOT_YET),
)


def write_table(frame: pd.DataFrame, path: str | Path, name: str, unit: str = "m") -> None:
    """Write a table whose columns are those of its kind, in their order; times to 1 ns."""
    expected = TABLES[name].names(unit)
    if list(frame.columns) != expected:
        missing = [column for column in expected if column not in frame.columns]
        extra = [column for column in frame.columns if column not in expected]
        raise SignkinError(
            f"columns missing: {listed(missing)}; not declared: {listed(extra)}",
            file=path,
            place=f"table {name}",
            expected=listed(expected, 40),
        )
    frame.to_csv(path, index=False, float_format="%.9g", lineterminator="\n")


def read_table(path: str | Path, name: str) -> pd.DataFrame:
    """Read a table as it was written: text stays text (`0000`), an empty cell of text is ''."""
    kinds = {n: c for c in TABLES[name].columns for n in {c.name.format(u=u) for u in LENGTH_UNITS}}
    header = pd.read_csv(path, nrows=0).columns
    text = [column for column in header if column in kinds and kinds[column].text]
    frame = pd.read_csv(
        path,
        dtype=dict.fromkeys(text, "str"),
        keep_default_na=False,
        na_values={column: [""] for column in header if column not in text},
    )
    return frame


def concatenated(paths: Iterable[str | Path], name: str, unit: str = "m") -> pd.DataFrame:
    """Read tables of one kind and put them below one another, in the order given."""
    parts = [read_table(path, name) for path in paths]
    kept = [part for part in parts if len(part)]
    return pd.concat(kept, ignore_index=True) if kept else empty(name, unit)


def empty(name: str, unit: str = "m") -> pd.DataFrame:
    """Return a table without rows."""
    return pd.DataFrame(columns=TABLES[name].names(unit))


def dictionary() -> str:
    """Return the data dictionary as Markdown."""
    lines = [
        "# Data dictionary",
        "",
        "Made from `src/signkin/tables.py` by `python -m signkin.tables`; edit it there.",
        "A `{u}` in a name is the corpus's unit of length, `m` or `px`. An empty cell is a value",
        "that does not exist; where it needs saying, the column `note` says why.",
    ]
    for table in TABLES.values():
        lines += ["", f"## {table.name}", "", f"`{table.path}`: one row is {table.row}.", ""]
        lines += ["| column | unit | meaning |", "|---|---|---|"]
        lines += [f"| `{c.name}` | {c.unit} | {c.meaning} |" for c in table.columns]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(dictionary(), end="")
