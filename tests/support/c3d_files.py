"""C3D files with events, written by ezc3d."""

import numpy as np
import pytest


def write_events(path, events, first_frame=0):
    """Write (label, context, description, seconds); return the path and the events read back."""
    ezc3d = pytest.importorskip("ezc3d", reason="the optional library ezc3d is not there")
    pytest.importorskip("c3d", reason="the optional library c3d is not there")
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [50.0]
    file["parameters"]["POINT"]["LABELS"]["value"] = ("RWRI", "LWRI")
    file["parameters"]["POINT"]["UNITS"]["value"] = ("mm",)
    file["data"]["points"] = np.ones((4, 2, 40))
    file["header"]["points"]["first_frame"] = first_frame
    for key, place in (("LABELS", 0), ("CONTEXTS", 1), ("DESCRIPTIONS", 2)):
        file.add_parameter("EVENT", key, [event[place] for event in events])
    times = np.array([event[3] for event in events])
    file.add_parameter("EVENT", "TIMES", np.stack([times // 60, times % 60]))
    file.write(str(path))
    return path, ezc3d.c3d(str(path))["parameters"]["EVENT"]
