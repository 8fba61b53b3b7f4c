"""What a run consists of: which corpora are there, where their files are, how they are sharded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from signkin.corpus import (
    Corpus,
    Entry,
    data_dir_of,
    data_folder,
    load_corpora,
)
from signkin.corpus_files import check_files
from signkin.errors import SignkinError, listed
from signkin.provenance import code_digest
from signkin.ratings import TAG_FILE
from signkin.settings import Settings, load_settings
from signkin.settings.checks import check_rate, check_shown_orders
from signkin.stages.remote import Remote, is_address


@dataclass(frozen=True)
class Plan:
    """The corpora of a run, and its settings.

    corpora: those whose data are there, by name. folders: their data folders.
    missing: corpus -> why it is left out of this run. remote: storage that recordings are fetched
    from, where they do not lie on this machine, and addresses the folders there, by corpus.
    """

    corpora: Mapping[str, Corpus]
    folders: Mapping[str, Path]
    missing: Mapping[str, str]
    settings: Settings
    root: Path
    papers: Path
    remote: Remote | None = None
    addresses: Mapping[str, str] = field(default_factory=dict)

    @property
    def tagged(self) -> list[str]:
        """Corpora with sign tags, which Naert et al.'s analyses can run on."""
        return [name for name, corpus in self.corpora.items() if corpus.tagged]

    @property
    def untagged(self) -> list[str]:
        """Corpora without tags."""
        return [name for name, corpus in self.corpora.items() if not corpus.tagged]

    @property
    def with_found_signs(self) -> list[str]:
        """Corpora without tags that say which of their takes hold one sign each."""
        return [
            n for n in self.untagged if self.corpora[n].settings.get("synthesis", {}).get("signs")
        ]

    def corpora_files(self, corpus: str) -> list[str]:
        """Return all data files of a corpus."""
        return self._there(corpus, self.corpora[corpus].files())

    @property
    def continuous(self) -> list[str]:
        """The other corpora, whose wrists are binned as long series."""
        return [name for name, corpus in self.corpora.items() if not corpus.single_signs]

    @property
    def oriented(self) -> list[str]:
        """Tagged corpora with orientations, recorded or made, which a duration surface needs."""
        motion = {name: self.corpora[name].settings["motion"] for name in self.tagged}
        return [name for name, m in motion.items() if m.get("orientations", "none") != "none"]

    @property
    def with_elan(self) -> list[str]:
        """Corpora whose tags are ELAN files, which are copied; others get new ELAN files."""
        return [
            name
            for name in self.tagged
            if self.corpora[name].settings["annotation"]["format"] == "eaf"
        ]

    @property
    def simulated(self) -> dict[str, str]:
        """The corpus that each simulator makes in this run: simulator -> corpus."""
        out: dict[str, str] = {}
        for name, corpus in self.corpora.items():
            if corpus.simulator is None or not corpus.made_by_run:
                continue
            if corpus.simulator in out:
                raise SignkinError(
                    f"the simulator {corpus.simulator} makes {out[corpus.simulator]} and {name}",
                    place="key simulator",
                    expected="one corpus for each simulator",
                )
            out[corpus.simulator] = name
        return out

    @property
    def single_signs(self) -> list[str]:
        """Corpora whose recordings hold one sign each, which Endres et al.'s analyses run on."""
        return [name for name, corpus in self.corpora.items() if corpus.single_signs]

    def shards(self, corpus: str) -> list[str]:
        """Return the names of a corpus's shards: `0001` and so on, `10000` after `9999`."""
        n = len(self.corpora[corpus].entries)
        return [f"{i + 1:04d}" for i in range((n - 1) // self.settings.recordings_per_job + 1)]

    def entries(self, corpus: str, shard: str) -> list[Entry]:
        """Return the recordings of a shard."""
        first = (int(shard) - 1) * self.settings.recordings_per_job
        return list(self.corpora[corpus].entries[first : first + self.settings.recordings_per_job])

    def names(self, corpus: str, shard: str) -> list[str]:
        """Return the names of the recordings of a shard."""
        return [entry.recording for entry in self.entries(corpus, shard)]

    def files(self, corpus: str, shard: str) -> list[str]:
        """Return the data files that a shard's recordings lie in."""
        names = [n for e in self.entries(corpus, shard) for n in (e.motion, e.annotation) if n]
        return self._there(corpus, list(dict.fromkeys(names)))

    def annotation_files(self, corpus: str, shard: str) -> list[str]:
        """Return the annotation files of a shard's recordings."""
        names = dict.fromkeys(e.annotation for e in self.entries(corpus, shard) if e.annotation)
        return self._there(corpus, list(names))

    @property
    def with_annotators(self) -> list[str]:
        """Corpora that name several annotators."""
        return [name for name in self.tagged if self.corpora[name].annotators]

    def annotator_files(self, corpus: str) -> list[str]:
        """Return the annotation files of the further annotators of a corpus that are there."""
        return self._there(corpus, self.corpora[corpus].annotator_files())

    def fetched_files(self) -> list[str]:
        """Return all data files that are fetched from storage."""
        return [file for corpus in self.addresses for file in self.corpora_files(corpus)]

    def _there(self, corpus: str, names: list[str]) -> list[str]:
        """Return the paths of data files; a corpus that skips recordings may lack some."""
        if self.remote and (address := self.addresses.get(corpus)):
            return [self.remote.recorded(address, name) for name in names]
        paths = [self.folders[corpus] / name for name in names]
        skips = self.corpora[corpus].skips
        return [str(path) for path in paths if not skips or path.exists()]

    def description(self, corpus: str) -> list[str]:
        """Return the files of the corpus's own folder."""
        folder = self.corpora[corpus].folder
        names = ("corpus.yaml", "recordings.csv", "signs.csv", TAG_FILE)
        return [str(folder / name) for name in names if (folder / name).is_file()]

    @property
    def claimed(self) -> list[Path]:
        """Folders of papers with a ledger of claims."""
        return sorted(file.parent for file in self.papers.glob("*/claims.yaml"))

    def claim_files(self) -> list[str]:
        """Return the claims and printed tables of those papers."""
        files = (f for folder in self.claimed for p in ("claims.yaml", "*.csv")
                 for f in sorted(folder.glob(p)))  # fmt: skip
        return [str(file) for file in files]

    def digest(self, script: str) -> str:
        """Return the digest of a workflow script and the library behind it."""
        return code_digest(self.root / "workflow" / "scripts" / script)


def make_plan(
    config: Mapping[str, Any], root: str | Path, results: str = "results",
    remote: Remote | None = None,
) -> Plan:  # fmt: skip
    """Check the configuration and every corpus, and find out what can be run.

    config: the content of config.yaml. root: the folder of the Snakefile, where corpora and papers
    lie unless the working directory has homes of its own of these names. remote: what fetches
    recordings where data_dir is an address.
    """
    settings = load_settings(config)
    check_shown_orders(settings, "config.yaml")
    root = Path(root)
    corpora = load_corpora(
        _own_or_shipped(settings.corpora_dir, root),
        None if settings.corpora == "all" else list(settings.corpora),
    )
    _check_utterances(settings, root, corpora)
    data_dir = data_dir_of(settings.data_dir)
    fetched = is_address(data_dir)
    if fetched and remote is None:
        raise SignkinError(
            f"{data_dir} is an address, from which `signkin run` alone fetches",
            place="data_dir",
            expected="a folder",
            todo="Copy the recordings to a folder and set SIGNKIN_DATA to it.",
        )
    if data_dir is not None and not fetched and not Path(data_dir).is_dir():
        raise SignkinError(
            f"there is no folder {data_dir}",
            place="data_dir",
            expected="the folder of the real recordings",
            todo="Correct make DATA=..., SIGNKIN_DATA or data_dir in config.yaml.",
        )
    there: dict[str, Corpus] = {}
    folders: dict[str, Path] = {}
    missing: dict[str, str] = {}
    addresses: dict[str, str] = {}
    for name, corpus in corpora.items():
        folder = data_folder(corpus, None if fetched else data_dir, Path(results))
        if folder is None and fetched and remote and data_dir:
            folder = remote.folder(corpus, data_dir)
            if folder is not None:
                addresses[name] = remote.address(corpus, data_dir)
        if folder is None:
            missing[name] = _why_missing(corpus, data_dir)
            continue
        if not corpus.made_by_run and name not in addresses:
            check_files(corpus, folder)
        if corpus.declared_rate_hz is not None:
            check_rate(settings, corpus.declared_rate_hz, name, "config.yaml")
        there[name], folders[name] = corpus, folder
    order = sorted(there, key=lambda name: (there[name].simulator is None, name))
    return Plan(
        corpora={name: there[name] for name in order},
        folders=folders,
        missing=missing,
        settings=settings,
        root=root,
        papers=_own_or_shipped(settings.papers_dir, root),
        remote=remote,
        addresses=addresses,
    )


def _check_utterances(settings: Settings, root: Path, corpora: Mapping[str, Corpus]) -> None:
    """Refuse an utterance of a corpus that has no folder; one that is not in the run may stand."""
    homes = (Path(settings.corpora_dir), root / settings.corpora_dir)
    for wanted in settings.synthesis.utterances:
        if not any((folder / wanted.corpus).is_dir() for folder in homes):
            raise SignkinError(
                f"no corpus {wanted.corpus!r}",
                file="config.yaml",
                place=f"key synthesis.utterances, {wanted.name}",
                expected=listed(corpora),
            )


def _own_or_shipped(folder: str, root: Path) -> Path:
    return Path(folder) if Path(folder).is_dir() else root / folder


def _why_missing(corpus: Corpus, data_dir: str | None) -> str:
    name = corpus.settings.get("data_folder", corpus.name)
    if data_dir is None:
        return "no folder of real recordings is set (data_dir, SIGNKIN_DATA or make DATA=...)"
    return f"there is no folder {name} in {data_dir}"
