"""Faults in a run, one after the other, and what the next run makes of them: a table.

    make test-faults                       all of them; 20 kills of the whole run, 10 of single jobs
    make test-faults ARGS="--kills 3"      fewer kills
    make test-faults ARGS="--write"        the rows into the table of docs/reliability.md as well

The run is that of a mini corpus up to its tables of refined tags: ten jobs, some in step. What
the next run gives is compared, byte by byte, with a run that nobody disturbed.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from signkin.lock import held
from support.runs import (
    ROOT,
    Run,
    command,
    environment,
    files_of,
    prepare,
    run,
    signkin,
    write_mini,
)

TARGET = "results/naert2017/mini/table2.csv"
INTERMEDIATES = ("results/mini/shards/0001/intervals.csv", "results/mini/kinematics/0002.parquet")
DOC = ROOT / "docs" / "reliability.md"
MARKS = ("<!-- begin:faults -->", "<!-- end:faults -->")
PATIENCE_S = 3600  # where others work, too, a run of half a minute takes many


@dataclass(frozen=True)
class Row:
    """A fault: what was done, what the next run gave, and whether that is as promised."""

    fault: str
    done: str
    then: str
    kept: bool


class Bench:
    """A prepared run of a mini corpus, what it makes undisturbed, and copies of it to disturb."""

    def __init__(self, base: Path) -> None:
        """Prepare and run; takes as long as the run."""
        self.base = base
        self.model = prepare(base / "model", corpora=["mini"], recordings_per_job=1)
        self.data = base / "data"
        write_mini(self.model, self.data)
        start = time.monotonic()
        done = self.finish(self.fresh("undisturbed"))
        assert done.status == 0, done.text
        self.seconds = time.monotonic() - start
        self.files = files_of(done.results)

    def fresh(self, name: str) -> Path:
        """Return a folder in which nothing has been run."""
        return Path(shutil.copytree(self.model, self.base / name))

    def finished(self, name: str) -> Path:
        """Return a copy of the undisturbed run."""
        return Path(shutil.copytree(self.base / "undisturbed", self.base / name))

    def finish(self, folder: Path, cores: int = 2, data: Path | None = None) -> Run:
        words = ["--cores", str(cores), "--", TARGET]
        return run(folder, *words, data=data or self.data, timeout=PATIENCE_S)

    @contextmanager
    def running(self, folder: Path, until: str = "") -> Iterator[subprocess.Popen[bytes]]:
        """Run, in a session of its own, until a file is there; what is left of it is killed."""
        log = (folder / "run.log").open("wb")
        process = subprocess.Popen(
            command("--cores", "2", "--", TARGET), cwd=folder, env=environment(self.data),
            start_new_session=True, stdout=log, stderr=subprocess.STDOUT,
        )  # fmt: skip
        try:
            if until:
                wait_for(lambda: process.poll() is not None or any(folder.glob(until)))
            yield process
        finally:
            for pid in members(process.pid):
                os.kill(pid, signal.SIGKILL)
            process.wait()
            log.close()

    def equal(self, folder: Path) -> str:
        """Return how results differ from the undisturbed ones; empty where they do not."""
        found = files_of(folder / "results")
        differing = [name for name in self.files if found.get(name) != self.files[name]]
        more = sorted(found.keys() - self.files.keys())
        return ", ".join([*differing, *more][:3])

    def then(self, folder: Path, cores: int = 2) -> tuple[str, bool]:
        """Run again; returns what came of it, in words, and whether it is the same bytes."""
        done = self.finish(folder, cores)
        if done.status:
            return f"status {done.status}: {sentence(done.text)}", False
        other = self.equal(folder)
        return (f"differs: {other}", False) if other else ("equal bytes", True)


def wait_for(condition: Callable[[], bool], seconds: float = PATIENCE_S) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def members(session: int) -> list[int]:
    """Return the living processes of a session (Linux)."""
    out = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # at an end meanwhile
        if int(fields[3]) == session and fields[0] != "Z":
            out.append(int(stat.parent.name))
    return out


def named(session: int, word: str) -> list[int]:
    """Return those whose command line holds a word."""
    out = []
    for pid in members(session):
        try:
            if word.encode() in Path(f"/proc/{pid}/cmdline").read_bytes():
                out.append(pid)
        except OSError:
            continue
    return out


def sentence(text: str) -> str:
    """Return what signkin itself said last, else the last line."""
    lines = [line for line in text.splitlines() if line.strip()]
    own = [line for line in lines if line.startswith("signkin: ")]
    return (own or lines or [""])[-1].removeprefix("signkin: ")


def row_of_many(fault: str, done: str, found: Sequence[tuple[str, bool]]) -> Row:
    """Return the row of a fault that was tried several times; found: as `Bench.then` tells."""
    kept = sum(ok for _, ok in found)
    worst = next((then for then, ok in found if not ok), "")
    told = f"{kept} of {len(found)} equal bytes" + (f"; {worst}" if worst else "")
    return Row(fault, done, told, kept == len(found))


# --- kills and signals -------------------------------------------------------------------------


def kill_of_all(bench: Bench, number: int, of: int) -> tuple[str, bool]:
    """Kill every process of a run at the `number`th of so many moments; run again on one core."""
    folder = bench.fresh(f"kill-{number}")
    with bench.running(folder) as process:
        time.sleep(bench.seconds * (number + 0.5) / of)
        os.killpg(process.pid, signal.SIGKILL)
    return bench.then(folder, cores=1)


def kills(bench: Bench, count: int) -> Iterator[Row]:
    found = [kill_of_all(bench, number, count) for number in range(count)]
    done = f"{count} runs, at evenly spread moments; again on one core"
    yield row_of_many("all processes killed", done, found)


ENDED = "results/mini/recordings/0001.parquet"  # the first thing that is made of the corpus


def signals(bench: Bench) -> Iterator[Row]:
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        for whole in (False, True):
            folder = bench.fresh(f"{name}-{whole}")
            with bench.running(folder, until=ENDED) as process:
                early = process.poll() is not None
                if not early:
                    (os.killpg if whole else os.kill)(process.pid, getattr(signal, name))
                ended = not early and wait_for(lambda: process.poll() is not None, 60)
                nothing = wait_for(lambda: not members(process.pid), 20)
                told = "ended, nothing left" if ended and nothing else "something outlived it"
                if early:
                    told = f"over before: {sentence((folder / 'run.log').read_text())}"
            then, ok = bench.then(folder)
            to = "the group" if whole else "the command alone"
            yield Row(f"{name} to {to}", told, then, ok and ended and nothing)


def parts_killed(bench: Bench) -> Iterator[Row]:
    """Kill the command alone, Snakemake alone, and the process that jobs are forked from."""
    for what, word in (
        ("the command", "signkin\0run"),
        ("Snakemake", "signkin.forked"),
        ("the process that jobs are forked from", "multiprocessing.forkserver"),
    ):
        folder = bench.fresh(f"part-{word.partition('.')[2] or 'command'}")
        with bench.running(folder, until=ENDED) as process:
            pids = named(process.pid, word)[:1]
            for pid in pids:
                os.kill(pid, signal.SIGKILL)
            beside = ""
            if what == "the command":
                with held(folder / ".snakemake" / "signkin.lock") as lock:
                    beside = "a run beside what is left is refused; " if lock is None else ""
            nothing = wait_for(lambda: not members(process.pid), 120)
        then, ok = bench.then(folder)
        told = "killed" if pids else "not found"
        left = "nothing is left" if nothing else "something is left after 120 s"
        yield Row(f"{what} killed alone", f"{told}; {beside}{left}", then, ok and nothing)


def jobs_of(session: int) -> list[int]:
    """Return the jobs that run: forks of the process that jobs are forked from."""
    servers = set(named(session, "multiprocessing.forkserver"))
    out = []
    for pid in servers:
        try:
            parent = int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
        except OSError:
            continue
        out += [pid] if parent in servers else []
    return sorted(out)


def job_killed(bench: Bench, number: int) -> tuple[str, bool]:
    """Kill the `number`th job that is seen, and run again."""
    folder = bench.fresh(f"job-{number}")
    seen: set[int] = set()
    with bench.running(folder) as process:
        while process.poll() is None and len(seen) < number:
            for pid in set(jobs_of(process.pid)) - seen:
                seen.add(pid)
                if len(seen) == number:
                    os.kill(pid, signal.SIGKILL)
            time.sleep(0.005)
        process.wait(PATIENCE_S)
    if "was killed (signal 9)" not in (folder / "run.log").read_text() or not process.returncode:
        return f"status {process.returncode}, the kill is not told", False
    return bench.then(folder)


def jobs_killed(bench: Bench, count: int) -> Iterator[Row]:
    found = [job_killed(bench, 1 + number) for number in range(count)]
    done = f"{count} runs, the 1st to {count}th job; the run fails and says so"
    yield row_of_many("a single job killed", done, found)


def second_run(bench: Bench) -> Iterator[Row]:
    """Start a run beside one that is at work."""
    folder = bench.fresh("second")
    with bench.running(folder, until=ENDED) as process:
        os.kill(process.pid, signal.SIGSTOP)  # however slow the other one starts, it is not over
        try:
            beside = bench.finish(folder)
        finally:
            os.kill(process.pid, signal.SIGCONT)
        at_work = process.poll() is None
        process.wait(PATIENCE_S)
    other = bench.equal(folder)
    then = f"differs: {other}" if other else "the first run ends with equal bytes"
    refused = at_work and beside.status == 1 and "another run is at work" in beside.text
    said = sentence(beside.text).replace(str(folder), "...")
    yield Row("a second run beside", f"status {beside.status}: “{said}”", then,
              refused and not process.returncode and not other)  # fmt: skip


def leftovers(bench: Bench) -> Iterator[Row]:
    """Ask for what failed jobs left half made to be kept."""
    folder = bench.fresh("leftovers")
    done = run(folder, "--keep-incomplete", "--", TARGET, data=bench.data)
    nothing = not (folder / "results").exists()
    then, ok = bench.then(folder)
    yield Row("`--keep-incomplete`", f"status {done.status}: “{sentence(done.text)}”", then,
              ok and nothing and done.status == 1)  # fmt: skip


# --- files -------------------------------------------------------------------------------------


def flip(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 4
    path.write_bytes(data)


def halve(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def head(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:4] if path.suffix == ".parquet" else
                     path.read_bytes().splitlines(keepends=True)[0])  # fmt: skip


DAMAGE: Mapping[str, Callable[[Path], object]] = {
    "a bit flipped": flip,
    "halved": halve,
    "emptied": lambda path: path.write_bytes(b""),
    "the header alone left": head,
    "deleted": lambda path: path.unlink(),
}


def damaged(bench: Bench) -> Iterator[Row]:
    """Damage a table and a Parquet file in the middle, and the last table, in a finished run."""
    for name, damage in DAMAGE.items():
        folder = bench.finished(f"damage-{name}")
        for file in (*INTERMEDIATES, TARGET):
            damage(folder / file)
        listed = signkin("verify", folder=folder).text
        done = bench.finish(folder)
        told = sum(f"{file} is not what its job wrote" in done.text for file in INTERMEDIATES)
        what = "`verify` lists them" if all(f in listed for f in INTERMEDIATES) else "not listed"
        other = bench.equal(folder)
        kept = done.status == 0 and not other and (told == len(INTERMEDIATES) or name == "deleted")
        then = f"equal bytes, {told} of 2 told" if not other else f"differs: {other}"
        yield Row(f"intermediates: {name}", f"a CSV, a Parquet and the last table; {what}", then,
                  kept)  # fmt: skip


def deleted(bench: Bench) -> Iterator[Row]:
    for what in ("results", ".snakemake", "logs"):
        folder = bench.finished(f"deleted-{what}")
        shutil.rmtree(folder / what)
        yield Row(f"{what}/ deleted", "in a finished run", *bench.then(folder))


def full_disk(bench: Bench) -> Iterator[Row]:
    """Give results a file system with less room than they want, and then more."""
    folder = bench.fresh("full")
    results = folder / "results"
    results.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(results)]
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        yield Row("full disk", "not tried: mounting wants root", "", True)
        return
    try:
        first = bench.finish(folder)
        more = ["mount", "-o", "remount,size=200m", str(results)]
        subprocess.run(more, check=True)
        then, ok = bench.then(folder)
    finally:
        subprocess.run(["umount", str(results)], check=False)
    yield Row("full disk", f"64 kB for results: status {first.status}, “{sentence(first.text)}”",
              f"with more room, {then}", ok and first.status != 0)  # fmt: skip


# --- the corpus, the clock, the place ----------------------------------------------------------


def edited(bench: Bench) -> Iterator[Row]:
    """Edit a tag file while the run is past it; the next run is that of the edited corpus."""
    folder, data = bench.fresh("edited"), bench.base / "edited-data"
    shutil.copytree(bench.data, data)
    plain, bench.data = bench.data, data
    try:
        with bench.running(folder, until="results/mini/intervals.csv") as process:
            tags = data / "mini" / "t1.csv"
            tags.write_text(tags.read_text().replace("1.05,", "1.10,"))
            process.wait(PATIENCE_S)
        bench.finish(folder)
        anew = bench.finish(bench.fresh("edited-anew"))
        same = files_of(folder / "results") == files_of(anew.results)
        other = bench.equal(folder)
    finally:
        bench.data = plain
    yield Row("corpus edited in a run", "a tag moved after it was read",
              "the bytes of a run of the edited corpus" if same and other else "others",
              same and bool(other))  # fmt: skip


def clock(bench: Bench) -> Iterator[Row]:
    """Put times of files as a clock leaves them that was set back by a year."""
    year = 365 * 86_400
    for what, pattern in (("results", "results/**/*"), ("the corpus", "corpora/**/*")):
        folder = bench.finished(f"clock-{what}")
        for path in folder.glob(pattern):
            if path.is_file():
                at = path.stat().st_mtime - year
                os.utime(path, (at, at))
        yield Row(f"clock set back: {what} of last year", "`touch -d`", *bench.then(folder))


def odd_place(bench: Bench) -> Iterator[Row]:
    """Run a checkout and a Python below a path that a shell and a glob take apart."""
    home = bench.base / "my signs & [x] it's"
    (home / "checkout").mkdir(parents=True)
    for name in ("src", "workflow", "profiles", "papers", "corpora"):
        kept = shutil.ignore_patterns("data", "__pycache__")
        shutil.copytree(ROOT / name, home / "checkout" / name, ignore=kept)
    shutil.copy(ROOT / "Snakefile", home / "checkout")
    (home / "venv").symlink_to(sys.prefix)
    folder = Path(shutil.copytree(bench.model, home / "run"))
    python = home / "venv" / "bin" / "python"
    env = {**environment(bench.data), "PYTHONPATH": str(home / "checkout" / "src")}
    done = subprocess.run(
        [str(python), "-m", "signkin", "run", "--cores", "2", "--", TARGET], cwd=folder, env=env,
        capture_output=True, text=True, timeout=PATIENCE_S, check=False,
    )  # fmt: skip
    other = bench.equal(folder)
    then = "equal bytes" if not done.returncode and not other else (
        f"status {done.returncode}: {sentence(done.stdout + done.stderr)} {other}"
    )  # fmt: skip
    place = "a path with a space, &, brackets, a quote"
    yield Row(place, "checkout, Python and run below it", then, then == "equal bytes")


# --- the table ---------------------------------------------------------------------------------

PARTS: Mapping[str, Callable[[Bench], Iterator[Row]]] = {
    "signals": signals,
    "parts": parts_killed,
    "second": second_run,
    "leftovers": leftovers,
    "damaged": damaged,
    "deleted": deleted,
    "disk": full_disk,
    "edited": edited,
    "clock": clock,
    "place": odd_place,
}


def table(rows: list[Row], before: str) -> str:
    """Return the table with new rows, each in the place of an older one of its fault."""
    head = "| fault | what was done | what the next run gave | |"
    old = [line for line in before.splitlines() if line.startswith("| ") and line != head]
    lines = {line.split(" | ")[0].removeprefix("| "): line for line in old}
    for r in rows:
        mark = "" if r.kept else "**not kept**"
        lines[r.fault] = f"| {r.fault} | {r.done} | {r.then} | {mark} |"
    return "\n".join([head, "|---|---|---|---|", *lines.values()])


def write(rows: list[Row]) -> None:
    """Put rows into the table of the document: what was found stays if the rest is stopped."""
    text = DOC.read_text(encoding="utf-8")
    start, end = (text.index(mark) for mark in MARKS)
    made = f"{MARKS[0]}\n\n{table(rows, text[start:end])}\n\n"
    DOC.write_text(text[:start] + made + text[end:], encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=10, help="kills of single jobs")
    parser.add_argument("--only", nargs="*", choices=["kills", "jobs", *PARTS], help="parts alone")
    parser.add_argument("--write", action="store_true", help=f"write the table to {DOC.name}")
    told = parser.parse_args()
    rows: list[Row] = []
    with tempfile.TemporaryDirectory(prefix="signkin-faults-") as folder:
        bench = Bench(Path(folder))
        print(f"undisturbed: {bench.seconds:.0f} s, {len(bench.files)} files", flush=True)
        parts: dict[str, Callable[[Bench], Iterator[Row]]] = {
            "kills": lambda b: kills(b, told.kills),
            "jobs": lambda b: jobs_killed(b, told.jobs),
            **PARTS,
        }
        for name in told.only or parts:
            for row in parts[name](bench):
                print("" if row.kept else "NOT KEPT", *vars(row).values(), sep=" | ", flush=True)
                rows.append(row)
                if told.write:
                    write([row])
    return 0 if all(row.kept for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
