"""Options of Snakemake that would break a promise of `signkin run` are refused."""

import pytest

from signkin import SignkinError
from signkin.options import refuse_options


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--default-storage-provider", "s3"], r"config.yaml, s3://bucket/folder. Set these two"),
        (["--profile", "storage"], r"^--default-storage-provider: .*data_dir and results_store"),
        (["-n", "--keep-incomplete"], r"^--keep-incomplete: what a failed job left half made"),
        (["--keep-inc"], r"^--keep-incomplete"),
        (["--workflow-profile=keeping"], r"^--keep-incomplete"),
    ],
)
def test_they_are_refused_on_the_line_and_in_profiles(tmp_path, words, told):
    for name, text in (("storage", "default-storage-provider: s3"), ("keeping",
                       "keep-incomplete: true")):  # fmt: skip
        (tmp_path / name).mkdir()
        (tmp_path / name / "profile.yaml").write_text(f"{text}\n")
    with pytest.raises(SignkinError, match=told):
        refuse_options(words, tmp_path)


def test_others_and_targets_are_not(tmp_path):
    refuse_options(
        ["--keep-going", "--default-resources", "mem_mb=9", "--", "--keep-inc"], tmp_path
    )
