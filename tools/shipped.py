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
    """Return the shipped settings with keys changed; see `changed`."""
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    return changed(load_settings(config), changes or {})


def changed(settings: Settings, changes: Mapping[str, Any]) -> Settings:
    """Return settings with keys changed, each named by its path (`binning.prior.dof`)."""
    config = settings.model_dump()
    for path, value in changes.items():
        *above, last = path.split(".")
        place = config
        for name in above:
            place = place[name]
        place[last] = value
    return load_settings(config)
