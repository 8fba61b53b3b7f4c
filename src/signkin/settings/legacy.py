"""Settings in the shape that config.yaml had, for rules that do not take sections yet."""

from __future__ import annotations

from typing import Any

from signkin.settings.sections import Settings


def legacy(settings: Settings) -> dict[str, Any]:
    """Return settings as the dictionary of before, with its key names."""
    out = settings.model_dump()
    choices = out.pop("open_choices")
    out["refinement"]["window_s"] = out["refinement"].pop("search_window_s")
    out["binning"]["window_s"] = out["binning"].pop("hit_window_s")
    del out["binning"]["lowpass"]["order"]
    out["binning"]["sensitivity"] = choices["endres2013"]
    naert = choices["naert2017"]
    naert["window_s"] = naert.pop("search_window_s")
    out["multiverse"] = naert
    return out
