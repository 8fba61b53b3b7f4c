"""Is there memory enough for the jobs of a run? Said before the first one starts.

A process that takes more than its limit is killed by the kernel without a word (a control group, a
cluster's job), or gets no more (`ulimit -v`), in the middle of a run.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from signkin.cost import read_costs
from signkin.errors import SignkinError

# A job that has imported what it imports and read nothing: 335 MB held, 805 MB of addresses
# (Linux, Python 3.11; measured after `import signkin.preloaded`).
LEAST_MB = 350.0
ADDRESSES_MB = 500.0  # what addresses are more than memory held
UNLIMITED_MB = 1e9


@dataclass(frozen=True)
class Limit:
    """A limit on memory (MB), and what sets it.

    each: of every job by itself, not of all. addresses: of addresses, not of memory held.
    """

    mb: float
    by: str
    each: bool = False
    addresses: bool = False


def limits(words: Iterable[str] = (), root: Path = Path("/")) -> Iterator[Limit]:
    """Yield the limits on memory that hold for this process and what it starts (Linux).

    words: arguments for Snakemake; `--resources mem_mb=...` is a limit too. root: of the file
    system, for tests.
    """
    for word in words:
        name, _, value = word.partition("=")
        if name == "mem_mb" and value.isdigit():
            yield Limit(float(value), "--resources mem_mb")
    if sys.platform == "win32":
        return
    import resource

    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if most != resource.RLIM_INFINITY:
        yield Limit(most / 1e6, "ulimit -v (RLIMIT_AS)", each=True, addresses=True)
    groups = [_number(file) for file in _group_files(root)]
    if groups and (least := min(groups)) < UNLIMITED_MB:
        yield Limit(least, "the control group (cgroup)")


def limits_of_jobs(profiles: Iterable[Mapping[str, object]]) -> Iterator[Limit]:
    """Yield the limits that profiles set on jobs that run on a cluster."""
    for profile in profiles:
        resources = profile.get("default-resources")
        asked = resources.get("mem_mb") if isinstance(resources, dict) else None
        if isinstance(asked, int | float):
            yield Limit(float(asked), "default-resources mem_mb of the profile", each=True)


def _group_files(root: Path) -> Iterator[Path]:
    """Yield the files that limit this process's control groups, version 2 and 1."""
    try:
        lines = (root / "proc/self/cgroup").read_text(encoding="utf-8").splitlines()
    except OSError:
        return
    for line in lines:
        _, _, kinds_and_place = line.partition(":")
        kinds, _, place = kinds_and_place.partition(":")
        if kinds and "memory" not in kinds.split(","):
            continue
        home = root / "sys/fs/cgroup" / ("memory" if kinds else "")
        name = "memory.limit_in_bytes" if kinds else "memory.max"
        folder = home / place.strip("/")
        for one in (folder, *folder.parents):
            if one.is_relative_to(home) and (one / name).is_file():
                yield one / name


def _number(file: Path) -> float:
    text = file.read_text(encoding="utf-8").strip()
    return float(text) / 1e6 if text.isdigit() else UNLIMITED_MB  # `max`


def need_mb(logs: Path) -> float:
    """Return the most that a job of an earlier run held (MB), or what each holds at least."""
    noted = [float(str(cost["peak_mb"])) for cost in read_costs(logs) if cost.get("peak_mb")]
    return max([LEAST_MB, *noted])


def check_memory(logs: Path, found: Iterable[Limit], cores: int) -> str:
    """Return what to say about memory before a run; '' where there is enough.

    logs: of the run's folder, in which an earlier run noted what its jobs held. found: limits.
    Raises SignkinError where no job can run.
    """
    need = need_mb(logs)
    told = ""
    for limit in found:
        more = ADDRESSES_MB if limit.addresses else 0.0
        wanted, least = need + more, LEAST_MB + more
        if limit.mb < least:
            raise SignkinError(
                f"memory is limited to {limit.mb:.0f} MB by {limit.by}, and a job takes "
                f"{least:.0f} MB before it has read anything",
                expected=f"at least {wanted:.0f} MB",
                todo="Raise the limit.",
            )
        at_once = 1 if limit.each else cores
        if limit.mb < wanted * at_once:
            fewer = max(1, int(limit.mb // wanted))
            remedy = "Raise it" if limit.each or cores == 1 else f"Raise it, or use --cores {fewer}"
            jobs = "A job" if at_once == 1 else f"{at_once} jobs at a time"
            told = (
                f"{jobs} may take {wanted * at_once:.0f} MB (the most a job of the last run held "
                f"is {need:.0f} MB), and memory is limited to {limit.mb:.0f} MB by {limit.by}. "
                f"{remedy}, should a job be killed."
            )
    return told
