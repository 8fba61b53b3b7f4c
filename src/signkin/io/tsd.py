"""Auslan time series (.tsd): two gloves with magnetic trackers, a row a frame, 22 columns.

Kadous 2002 (UCI 'Australian Sign Language signs (High Quality)'). For the left hand, then the
right one: x, y, z in metres, roll, pitch and yaw from 0 to 1, and the bend of five fingers. The
file tells no rate. Only positions are read: the donor does not say how the three angles follow
one another.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from signkin.io.archive import read_numbers
from signkin.io.chosen import pick
from signkin.io.registry import SourceMotion, motion_reader

JOINTS = ("left", "right")
COLUMNS_A_HAND = 11


@motion_reader("tsd", suffixes=(".tsd",))
def read_tsd(
    path: Path, *, joints: Mapping[str, str] | None = None, part: str | None = None
) -> SourceMotion:
    """Read both hands of one recording, a .tsd file or a member of an archive of them.

    joints: canonical name -> `left` or `right`. part: the member of the archive.
    """
    table = read_numbers(path, part, len(JOINTS) * COLUMNS_A_HAND)
    names, chosen = pick(JOINTS, joints)
    hands = table.reshape(len(table), len(JOINTS), COLUMNS_A_HAND)
    return SourceMotion(
        rate_hz=None, joints=names, positions=np.ascontiguousarray(hands[:, chosen, :3]), unit="m"
    )
