"""Arguments for Snakemake, on the command line and in profiles: what they ask, what is refused."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from signkin.errors import SignkinError
from signkin.yaml_file import read_yaml

PROFILE_FILES = ("profile.yaml", "config.yaml", "config.v8+.yaml")
# What would break a promise: option -> (why, what is expected, what to do).
REFUSED = {
    "default-storage-provider": (
        "with it Snakemake takes the descriptions of corpora and papers, too, from storage",
        "data_dir and results_store in config.yaml, s3://bucket/folder",
        "Set these two, and leave that option out.",
    ),
    "keep-incomplete": (
        "what a failed job left half made would count as done",
        "no such option",
        "Leave it out; the log of the job tells where it failed.",
    ),
}


def refuse_options(extra: Sequence[str], folder: Path) -> None:
    """Refuse arguments for Snakemake under which results are not what they should be.

    extra: those of the command line; profiles that they name are looked up from a folder.
    """
    told = extra[: extra.index("--")] if "--" in extra else extra
    names = {word.partition("=")[0].removeprefix("--") for word in told if word.startswith("--")}
    for option, (why, expected, todo) in REFUSED.items():
        # Snakemake takes the beginning of an option for it.
        on_line = any(len(name) > 6 and option.startswith(name) for name in names)
        if on_line or any(profile.get(option) for profile in profiles(extra, folder)):
            raise SignkinError(f"--{option}: {why}", expected=expected, todo=todo)


def executors(extra: Sequence[str], folder: Path) -> list[str]:
    """Return what is to run jobs instead of this machine, by arguments for Snakemake."""
    told = [str(options.get("executor") or "") for options in profiles(extra, folder)]
    return values(extra, "--executor", "-e") or [name for name in told if name]


def profiles(extra: Sequence[str], folder: Path) -> list[dict[str, object]]:
    """Return the settings of the profiles that arguments for Snakemake name."""
    return [_profile(folder / name) for name in values(extra, "--profile", "--workflow-profile")]


def values(words: Sequence[str], *options: str) -> list[str]:
    """Return the values of command line options, given as two words or with `=`."""
    out = []
    for i, word in enumerate(words):
        if word == "--":
            break
        name, equals, value = word.partition("=")
        if name in options:
            out += [value] if equals else list(words[i + 1 : i + 2])
    return out


def _profile(path: Path) -> dict[str, object]:
    """Return a profile's settings; none where it is not there: Snakemake tells of that."""
    for file in (path / name for name in PROFILE_FILES):
        if file.is_file():
            content = read_yaml(file)
            return content if isinstance(content, dict) else {}
    return {}
