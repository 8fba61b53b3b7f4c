"""Fixtures that run the workflow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from support.runs import MINI, mini_motion, prepare


@pytest.fixture
def mini(tmp_path) -> Callable[..., tuple[Path, Path]]:
    """Return a maker of a mini corpus: (folder of the run, folder of the data)."""

    def make(spoil: Callable[[Path, Path], None] = lambda corpus, data: None, **settings: object):
        folder = prepare(tmp_path / "run", corpora=["mini"])
        corpus, data = folder / "corpora" / "mini", tmp_path / "data" / "mini"
        corpus.mkdir(parents=True)
        data.mkdir(parents=True)
        (corpus / "corpus.yaml").write_text(yaml.safe_dump({**MINI, **settings}))
        (corpus / "recordings.csv").write_text(
            "recording,signer,motion,annotation\nm1,s1,m1.csv,t1.csv\nm2,s2,m2.csv,t2.csv\n"
        )
        (corpus / "signs.csv").write_text("gloss,hands,symmetric\nCAKE,1,1\nIX,0,0\n")
        for i in (1, 2):
            (data / f"m{i}.csv").write_text(mini_motion(12, i))
            tags = [(k + 0.05 * i, k + 0.6, ("CAKE", "IX", "NEW")[k % 3]) for k in range(1, 10)]
            rows = "".join(f"{a:.2f},{b:.2f},{g}\n" for a, b, g in tags)
            (data / f"t{i}.csv").write_text("start,end,gloss\n" + rows)
        spoil(corpus, data)
        return folder, tmp_path / "data"

    return make
