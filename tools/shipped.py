"""The settings of the shipped config.yaml, and the same with some keys changed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from signkin.settings.checks import load_settings
from signkin.settings.sections import Settings

ROOT = Path(__file__).resolve().parents[1]


def shipped(changes: Mapping[str, Any] | None = None) -> Settings:
    """Return the settings with keys changed, each named by its path (`binning.prior.dof`)."""
    config: dict[str, Any] = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    for path, value in (changes or {}).items():
        *above, last = path.split(".")
        place = config
        for name in above:
            place = place[name]
        place[last] = value
    return load_settings(config)
