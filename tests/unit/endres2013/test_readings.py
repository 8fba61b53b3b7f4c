"""The study without each rule that we add to the print, on a few recordings."""

import pytest

from signkin import tables
from signkin.io.store import write_recordings
from signkin.studies.endres2013 import readings as of
from signkin.studies.endres2013.settings import ReadingSettings
from support.endres import corpus_of, recording_of, settings, simulated

SETTINGS = ReadingSettings.of(
    settings(bins=40, orders=[0, 3], fitted_orders=[3], fitted_recordings=4,
             bootstrap_draws=100, chance_trajectories=200)
)  # fmt: skip


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    corpus, recordings = simulated(4)
    path = tmp_path_factory.mktemp("readings") / "0001.parquet"
    write_recordings(path, recordings)
    return of.readings(corpus, [path], SETTINGS, 2017, 1)


def test_each_table_has_its_columns_and_every_reading(found):
    for name, table in found.items():
        assert list(table.columns) == tables.TABLES[name].names("m")
    rates = found["readings_hit_rates"]
    assert set(rates["reading"]) >= {of.OURS, of.WINDOW, of.NOISE, of.ANY_FIT}
    assert set(found["readings_ground_truth"]["reading"]) >= {of.OURS, of.ANY_FIT}
    assert set(rates[rates["reading"] == of.NOISE]["dataset"]) == {"fitted", "fitted_map"}


def test_half_the_window_finds_no_more_and_changes_no_posterior(found):
    rates = found["readings_hit_rates"].set_index(["dataset", "true_order", "order"]).sort_index()
    whole, half = (rates[rates["reading"] == name]["hit_rate"] for name in (of.OURS, of.WINDOW))
    assert (half <= whole).all()
    assert (half < whole).any()
    orders = found["readings_order_posteriors"].set_index(["dataset", "true_order", "order"])
    same = [orders[orders["reading"] == n]["mean_probability"] for n in (of.OURS, of.WINDOW)]
    assert same[0].equals(same[1])


def test_the_noise_of_the_recordings_is_another_prior_on_the_same_trajectories(found):
    orders = found["readings_order_posteriors"].query("dataset == 'fitted' and true_order == 3")
    by = {name: part.set_index("order") for name, part in orders.groupby("reading")}
    assert by[of.NOISE]["n"].equals(by[of.OURS]["n"])
    assert not by[of.NOISE]["mean_probability"].equals(by[of.OURS]["mean_probability"])


def test_laws_without_our_rule_may_fit_worse(found):
    laws = found["readings_ground_truth"].groupby("reading")
    assert laws["r_squared"].min()[of.OURS] >= 0.97
    assert len(laws.get_group(of.ANY_FIT)) >= len(laws.get_group(of.OURS))


def test_recorded_and_ground_truth_come_in_pairs_of_equal_bins(found):
    pairs = found["equal_bins"].query("order == 3").pivot(
        index="recording", columns="dataset", values="n_bins"
    )  # fmt: skip
    assert len(pairs) >= 2
    assert (pairs["recorded"] == pairs["powerlaw"]).all()


def test_slow_sampling_gives_the_ground_truth_as_few_bins():
    """At 240 Hz ground truth has samples enough for all bins; 25 Hz has not."""
    corpus, recordings = simulated(2)
    slow = [
        recording_of(r.name, r.positions[::8, 0], r.positions[::8, 1], 30.0) for r in recordings
    ]
    wide = ReadingSettings.of(settings(bins=100))
    made = of.equal_bins(corpus, slow, wide, of.LAWS[of.ANY_FIT], 2017)
    assert made
    assert {len(one.x) for one in made if one.dataset == "powerlaw"} == {
        len(one.x) for one in made if one.dataset == "recorded"
    }
    assert all(len(one.x) < 100 for one in made)


def test_a_corpus_without_any_recording_has_empty_tables():
    out = of.readings(corpus_of(["a"]), [], SETTINGS, 1, 1)
    assert all(table.empty for table in out.values())
