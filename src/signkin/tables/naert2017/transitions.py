"""Sign types and transitions (Naert et al. 2017, section 5.1)."""

from __future__ import annotations

from signkin.tables.schema import LEAD, NOTE, SIGN, Column, Table, text

_FINAL = (
    Table(
        "transitions",
        "results/naert2017/<corpus>/transitions.csv, transitions_left_out.csv",
        "a transition between two signs of one utterance, for one segmentation and hand "
        "(Naert et al. 2017, section 5.1)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            text("previous_gloss", "sign before"),
            text("next_gloss", "sign after"),
            text(
                "type",
                "four digits: hands and symmetry of the sign before, then of the sign after "
                "(hands: 0 one, 1 two, 2 one with the other keeping the context)",
            ),
            text("type_source", "lexicon (signs.csv) or kinematic (inferred from motion)"),
            text("hand", "both (whole body), right or left (arm joints of that hand)"),
            text("segmentation", "manual or refined"),
            text("utterance", "utterance the transition belongs to"),
            Column("start_s", "s", "end of the sign before"),
            Column("end_s", "s", "start of the sign after"),
            Column("duration_s", "s", "end - start; below 0 where the signs overlap"),
            text("status", "ok, zero_length or overlap"),
            Column("geodesic_rad", "rad", "eq. 1, mean over joints of half the rotation angle"),
            Column("euclidean_{u}", "m or px", "eq. 2, mean over joints"),
            Column("n_joints", "", "joints in the Euclidean mean (gaps left out)"),
            Column("geodesic_norm", "", "geodesic, mean taken off, divided by the range"),
            Column("euclidean_norm", "", "Euclidean, mean taken off, divided by the range"),
            Column("mean_distance", "", "mean of the two (of the one, where one is missing)"),
            NOTE,
        ),
    ),
    Table(
        "sign_types",
        "results/naert2017/<corpus>/sign_types.csv",
        "a sign's type from the lexicon and from motion",
        (
            *LEAD,
            SIGN,
            text("gloss", "label of the sign"),
            Column("start_s", "s", "start of the sign"),
            Column("end_s", "s", "end of the sign"),
            text("utterance", "utterance the sign belongs to, empty for none"),
            text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
            text("kinematic", "two digits from motion"),
            text("type", "the two digits in use"),
            text("type_source", "lexicon or kinematic"),
            Column("activity", "", "path of the stiller wrist / path of the busier one"),
            Column("mirror", "", "correlation of the wrists' velocities, one mirrored"),
            Column("held_shift", "", "shift of the still wrist since the sign before, in reaches"),
            NOTE,
        ),
    ),
    Table(
        "lexicon",
        "results/naert2017/<corpus>/lexicon.csv",
        "a gloss of signs.csv or of the annotation",
        (
            text("corpus", "corpus"),
            text("gloss", "gloss"),
            text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
            Column("occurrences", "", "signs with this gloss in the corpus"),
            NOTE,
        ),
    ),
    Table(
        "transition_speeds",
        "results/naert2017/<corpus>/transition_speeds.csv",
        "a transition between manual tags with the mean speeds of the signs around it "
        "(Naert et al. 2017, section 5.2, eq. 3)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            *(
                Column(f"{side}_{kind}", unit, meaning.format(which))
                for kind, unit, meaning in (
                    (
                        "linear_speed_{u}_per_s",
                        "m/s or px/s",
                        "mean speed over joints and frames of the sign {}, low-passed",
                    ),
                    (
                        "angular_speed_rad_per_s",
                        "rad/s",
                        "same of the orientations, the angle as eq. 1 has it (half)",
                    ),
                )
                for side, which in (("previous", "before"), ("next", "after"))
            ),
            NOTE,
        ),
    ),
)

_TRANSITIONS = next(table for table in _FINAL if table.name == "transitions")
_NOT_YET = ("geodesic_norm", "euclidean_norm", "mean_distance", "note")
TABLES = (
    *_FINAL,
    Table(
        "raw_transitions",
        "results/naert2017/<corpus>/shards/<shard>/transitions.csv",
        "a transition before distances are normalised, which wants the whole corpus",
        tuple(c for c in _TRANSITIONS.columns if c.name not in _NOT_YET),
    ),
)
