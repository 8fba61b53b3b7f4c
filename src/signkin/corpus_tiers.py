"""Tiers and files that corpus.yaml names for all recordings, made those of one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from signkin.annotation import TierWish

if TYPE_CHECKING:
    from signkin.corpus import Entry


def is_by_hand(wanted: Any) -> bool:
    """Return whether tiers are told by hand, and not one for both."""
    return isinstance(wanted, Mapping) and not {"pattern", "participant"} & set(wanted)


def filled(wish: TierWish, entry: Entry) -> TierWish:
    """Return a wish with the recording's own names in place of `{recording}` and the like."""
    if isinstance(wish, Mapping):
        return {key: str(filled(value, entry)) for key, value in wish.items()}
    if "{" not in wish:
        return wish
    for key in ("signer", "recording", "part"):
        wish = wish.replace(f"{{{key}}}", getattr(entry, key))
    return wish
