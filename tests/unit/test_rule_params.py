from dataclasses import dataclass
from pathlib import Path

from signkin.rule_params import COMPARED, told_as_text
from signkin.settings import Settings
from signkin.studies.naert2017.settings import TableSettings


@dataclass(frozen=True)
class Own:
    share: float


def test_settings_are_told_and_what_is_compared_is_not():
    params = {
        "code": "ab12", "seed": 3, "groups": ("a", "b"), "corpora": {"x": True}, "none": None,
        "unit": lambda wildcards: "m", "settings": Own(0.2), "folder": Path("here"),
    }  # fmt: skip
    told = told_as_text(params)
    assert told.startswith("settings=Own(share=0.2); folder=") and "here" in told
    assert told_as_text({"code": "ab12", "unit": lambda wildcards: "m"}) == ""


def test_another_value_of_a_key_is_another_text():
    settings = Settings()
    refinement = settings.refinement.model_copy(update={"search_window_s": 0.16})
    changed = settings.model_copy(update={"refinement": refinement})
    before, after, again = (
        told_as_text({"settings": TableSettings.of(each)})
        for each in (settings, changed, Settings())
    )
    assert before == again != after


def test_snakemake_compares_what_is_said_to_be_compared():
    from snakemake.persistence import UNREPRESENTABLE, PersistenceBase

    told = PersistenceBase._serialize_param_builtin
    for kind in COMPARED:
        value = kind(1) if kind is range else kind()
        assert told(None, value) is not UNREPRESENTABLE
    assert told(None, Own(0.2)) is UNREPRESENTABLE
