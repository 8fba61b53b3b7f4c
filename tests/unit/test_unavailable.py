"""What an analysis that cannot run leaves: empty files, and why."""

from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest

from signkin.errors import SignkinError
from signkin.job import job
from signkin.tables import TABLES, read_table
from signkin.unavailable import kind_at, rows_of


class Named(list):
    """Like Snakemake's lists with names."""

    def items(self):
        return ()

    def get(self, name, default=None):
        return getattr(self, name, default)


def snakemake(folder, rule, outputs, inputs=(), **params):
    wildcards = Named(["mine"])
    wildcards.corpus = "mine"
    given = Named()
    vars(given).update(params)
    return SimpleNamespace(
        rule=rule, log=[f"logs/{rule}.log"], wildcards=wildcards, params=given, threads=1,
        input=Named(inputs), output=Named(outputs),
    )  # fmt: skip


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results/naert2017/mine").mkdir(parents=True)
    return tmp_path


TABLE = "results/naert2017/mine/statistics.csv"
FIGURE = [f"results/naert2017/mine/fig11.{s}" for s in ("svg", "pdf", "csv")]


def test_files_are_there_without_content_and_the_reason_is_kept(here, capsys):
    outputs = [*FIGURE, TABLE, "results/naert2017/mine/captions.json", "results/naert2017/mine/eaf"]
    with job(snakemake(here, "duration_surface", outputs, unit="px"), analysis=True):
        raise SignkinError("no transition", place="transitions")
    (row,) = rows_of(here / "results/mine/not_available").to_dict("records")
    assert row["analysis"] == "duration surface"
    assert row["reason"] == "transitions: no transition."
    assert (
        "signkin: mine: duration surface: not available: transitions: no" in capsys.readouterr().err
    )
    assert read_table(TABLE, "statistics").empty
    points = read_table(FIGURE[2], "surface_points")
    assert list(points.columns) == TABLES["surface_points"].names("px")
    assert "transitions: no transition" in (here / FIGURE[0]).read_text()
    assert (here / FIGURE[1]).read_bytes().startswith(b"%PDF")
    assert "Not available" in (here / outputs[4]).read_text()
    assert (here / outputs[5]).is_dir()


def test_a_part_that_fails_does_not_stop_the_others(here):
    statistics = pd.DataFrame(columns=TABLES["statistics"].names())
    with job(snakemake(here, "tables", [TABLE, FIGURE[2]], unit="m"), analysis=True) as work:
        with work.part("the surface", FIGURE[2]):
            raise ZeroDivisionError("division by zero")
        statistics.to_csv(TABLE, index=False)
    (row,) = rows_of(here / "results/mine/not_available").to_dict("records")
    assert row["part"] == "the surface"
    assert "ZeroDivisionError: division by zero (a fault of signkin" in row["reason"]
    assert "Traceback" in (here / "logs/tables.log").read_text()
    assert row["files"] == FIGURE[2]


def test_what_rests_on_it_has_the_same_reason_and_a_good_run_takes_it_back(here):
    first = snakemake(here, "duration_models", [TABLE], unit="m")
    with job(first, analysis=True):
        raise SignkinError("only one sign")
    second = snakemake(here, "duration_surface", FIGURE, [TABLE], unit="m")
    with job(second, analysis=True):
        raise KeyError("in_sample")
    rows = rows_of(here / "results/mine/not_available")
    assert rows["reason"].tolist() == ["only one sign.", "only one sign."]
    with job(first, analysis=True):
        pass
    assert rows_of(here / "results/mine/not_available")["analysis"].tolist() == ["duration surface"]


def test_what_is_no_analysis_ends_the_run(here):
    with pytest.raises(SystemExit), job(snakemake(here, "ingest", [TABLE])):
        raise SignkinError("a bad file")
    assert not (here / "results/mine").exists()


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("results/naert2017/c/transitions.csv", "transitions"),
        ("results/naert2017/c/shards/0001/transitions.csv", "raw_transitions"),
        ("results/naert2017/c/transitions_left_out.csv", "transitions"),
        ("results/naert2017/c/shards/0001/sign_types.csv", "sign_types"),
        ("results/naert2017/c/synthesis/utterances.csv", "utterances"),
        ("results/endres2013/c/shards/0001/not_cut.csv", "binning_left_out"),
        ("results/endres2013/c/figA1.csv", "endres_figure"),
        ("results/c/recordings/0001.parquet", ""),
    ],
)
def test_the_kind_of_a_table_is_found_by_its_place(path, kind):
    assert kind_at(Path(path)) == kind
