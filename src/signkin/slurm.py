"""What a SLURM cluster lacks is said before the first job, and how its jobs are asked for.

Snakemake's executor asks `sacct` how jobs stand wherever that command is installed. Where SLURM
keeps no accounts, `sacct` answers nothing, and the run would wait for ever: `squeue` is asked then.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from signkin.errors import SignkinError
from signkin.options import executors, profiles, values

STATUS = "--slurm-status-command"
# The executor asks squeue 40 s after a job was handed over, and up to three times.
LEAST_JOB_AGE_S = 120


def slurm_arguments(extra: Sequence[str], folder: Path) -> list[str]:
    """Return what to add to Snakemake's arguments where jobs go to SLURM; nothing where not.

    extra: arguments for Snakemake; profiles are looked up from a folder. Raises SignkinError where
    there is no SLURM, its controller does not answer, finished jobs cannot be asked for, or a
    partition of the profile or of the arguments does not exist.
    """
    if "slurm" not in executors(extra, folder):
        return []
    if shutil.which("sbatch") is None:
        raise SignkinError(
            "jobs are to go to SLURM, and this machine has no command sbatch",
            expected="a node of the cluster from which jobs are submitted",
            todo="Run there, or leave out the SLURM profile to run on this machine.",
        )
    config = _asked("scontrol", "show", "config")
    _check_partitions(extra, profiles(extra, folder))
    if values(extra, STATUS) or _config(config, "AccountingStorageType") not in (
        "accounting_storage/none", "(null)", "",
    ):  # fmt: skip
        return []
    age = int(re.sub(r"\D.*", "", _config(config, "MinJobAge")) or 0)
    if age < LEAST_JOB_AGE_S:
        raise SignkinError(
            f"SLURM keeps no accounts (AccountingStorageType) and forgets a finished job after "
            f"{age} s (MinJobAge): whether a job succeeded could not be told",
            expected=f"accounts (slurmdbd), or MinJobAge of at least {LEAST_JOB_AGE_S} s",
            todo="Ask the cluster's administrator for one of the two.",
        )
    return [STATUS, "squeue"]


def _asked(*command: str) -> str:
    """Return what one of SLURM's commands prints."""
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=60, check=False
        )  # fmt: skip
    except (OSError, subprocess.TimeoutExpired) as error:
        raise SignkinError(
            f"SLURM does not answer `{' '.join(command)}`: {type(error).__name__}",
            todo="Try the command by hand.",
        ) from error
    if done.returncode:
        lines = (done.stderr.strip() or done.stdout.strip() or "no message").splitlines()
        raise SignkinError(
            f"SLURM does not answer `{' '.join(command)}`: {lines[0]}",
            todo="Try the command by hand: the cluster's controller (slurmctld) may be down.",
        )
    return done.stdout


def _config(text: str, key: str) -> str:
    found = re.search(rf"^{key}\s*=\s*(.*)$", text, re.MULTILINE)
    return found.group(1).strip() if found else ""


def _check_partitions(extra: Sequence[str], told: Sequence[Mapping[str, object]]) -> None:
    """Refuse a partition that the cluster does not have.

    extra: arguments for Snakemake, whose default resources go before the profiles'. told: the
    settings of the profiles.
    """
    words = extra[: extra.index("--")] if "--" in extra else extra
    named = dict.fromkeys(_partitions(words), "--default-resources or --set-resources")
    on_line = any(word.partition("=")[0] == "--default-resources" for word in words)
    for options in told:
        resources = [*_mapping(options.get("set-resources")).values(), options.get("set-resources")]
        if not on_line:
            resources.append(options.get("default-resources"))
        for one in resources:
            named |= dict.fromkeys(_partitions(one), "the profile")
    if not named:
        return
    there = set(_asked("sinfo", "--noheader", "--format=%R").split())
    if missing := sorted(named.keys() - there):
        where = named[missing[0]]
        raise SignkinError(
            f"the slurm_partition {missing[0]!r} of {where} is not a partition of this cluster",
            expected=", ".join(sorted(there)) or "a partition (the cluster has none)",
            todo=f"Correct slurm_partition in {where}.",
        )


def _mapping(value: object) -> dict[str, object]:
    return value if isinstance(value, dict) else {}


def _partitions(resources: object) -> set[str]:
    """Return the partitions that resources name: a mapping, or words such as `step:name=value`."""
    if isinstance(resources, dict):
        named = [str(resources.get("slurm_partition") or "")]
    else:
        words = resources if isinstance(resources, (list, tuple)) else [resources]
        named = [_of_word(str(word)) for word in words]
    return {part for text in named for part in text.strip("'\"").split(",") if part}


def _of_word(word: str) -> str:
    found = re.search(r"(?:^|[:=])slurm_partition=(.*)$", word)
    return found[1] if found else ""
