"""config.yaml as settings: the shipped file, the generated ones, and what is refused."""

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from signkin import SignkinError
from signkin.settings import Settings, load_settings
from signkin.settings.__main__ import generated
from signkin.settings.checks import all_keys, check_rate
from signkin.settings.text import config_text, plain


def test_generated_files_are_as_the_models_say(root):
    for path, text in generated(root).items():
        assert path.read_text(encoding="utf-8") == text, f"{path} is old: run `make settings`"


def test_the_shipped_file_has_the_defaults(root):
    shipped = yaml.safe_load((root / "config.yaml").read_text())
    assert load_settings(shipped) == Settings() == load_settings({})


def test_what_is_written_is_read_again():
    changed = load_settings(
        {"binning": {"orders": [0, 3], "prior": {"dof": 4.5}}, "corpora": ["lsf-sim"], "seed": 3}
    )
    assert load_settings(yaml.safe_load(config_text(changed))) == changed
    assert plain(changed)["binning"]["orders"] == [0, 3]


def test_sections_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        Settings().refinement.draws = 5


def test_every_key_is_described():
    for name, field in all_keys(Settings):
        assert field.description or hasattr(field.annotation, "model_fields"), name


@pytest.mark.parametrize(
    ("config", "told"),
    [
        ({"kinematic": {}}, "there is no key kinematic; expected kinematics"),
        ({"kinematics": {"lowpas": {}}}, "expected kinematics.lowpass"),
        ({"kinematics": {"cutoff_hz": 3.0}}, "expected kinematics.lowpass.cutoff_hz, perhaps"),
        ({"refinement": {"window_s": 0.1}}, "expected refinement.search_window_s, its name now"),
        ({"multiverse": {}}, "expected open_choices.naert2017, its name now"),
        ({"seed": "x"}, "key seed: 'x'; expected a whole number"),
        ({"seed": True}, "key seed: True"),
        ({"binning": {"bins": 50.0}}, "key binning.bins: 50.0"),
        ({"refinement": {"search_window_s": 0}}, "search_window_s: 0; expected greater than 0"),
        ({"binning": {"orders": []}}, "expected a list of one value or more"),
        ({"binning": {"orders": [1, 1]}}, "1 stands there more than once"),
        ({"binning": {"orders": [7], "bins": 5}}, "order 7 with 5 bins; expected orders below 5"),
        ({"binning": {"prior": {"dof": float("nan")}}}, "expected a finite number"),
        ({"durations": {"alpha": 1e-300}}, "durations.alpha: 1e-300"),
        ({"durations": {"lowest_s": 0.6}}, "0.6 s with highest_s 0.5 s; expected below 0.5 s"),
        ({"refinement": {"draws": 10**9}}, "refinement.draws: 1000000000"),
        ({"refinement": None}, "expected keys of its own"),
        ({"kinematics": {"lowpass": {"method": "median"}}}, "lowpass.method: 'median'"),
        ({"powerlaw": {"least_exponent": 0.5}}, "least_exponent: 0.5 with most_exponent 0"),
        ({"binning": {"continuous": {"longest_segment_s": 0.02}}}, "a bin for each coefficient"),
        (
            {"synthesis": {"utterances": [{"corpus": "a", "name": "n", "glosses": ["x"]}] * 2}},
            "two utterances of a are named n",
        ),
        ({"results_store": "bucket/mine"}, "'bucket/mine' is no address, s3://bucket/folder"),
        ({"binning": {"prior": {"concentration": 1e-300}}}, "prior.concentration: 1e-300"),
        ({"binning": {"prior": {"dof": 1e-300}}}, "prior.dof: 1e-300; expected greater than 1"),
        ([], "no keys"),
    ],
)  # fmt: skip
def test_faults_are_told_in_one_sentence(config, told):
    with pytest.raises(SignkinError) as caught:
        load_settings(config)
    assert told in str(caught.value)
    assert str(caught.value).startswith("config.yaml")
    assert "\n" not in str(caught.value)


def test_a_cutoff_above_half_a_rate_is_refused():
    check_rate(Settings(), 25.0, "slow", "config.yaml")
    with pytest.raises(SignkinError, match=r"key kinematics.lowpass.cutoff_hz: .*slow has 12 Hz"):
        check_rate(Settings(), 12.0, "slow", "config.yaml")


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=5,
)
KEYS = [name for name, _ in all_keys(Settings)]


@given(key=st.sampled_from(KEYS), value=VALUES)
def test_any_value_is_taken_or_refused_with_its_key(key, value):
    config = value
    for part in reversed(key.split(".")):
        config = {part: config}
    try:
        load_settings(config)
    except SignkinError as error:
        assert str(error).startswith("config.yaml")
