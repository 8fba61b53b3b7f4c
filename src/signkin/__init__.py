"""signkin: reproducible analysis of sign-language motion.

The names below are the public ones at the top; the stages are subpackages
(`signkin.kinematics`, `signkin.coarticulation`, ...).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from signkin.annotation import Annotation, Interval
    from signkin.errors import SignkinError
    from signkin.io.registry import read_annotation, read_recording
    from signkin.recording import Recording

__version__ = "0.1.0"
__all__ = [
    "Annotation",
    "Interval",
    "Recording",
    "SignkinError",
    "read_annotation",
    "read_recording",
]

_HOMES = {
    "Annotation": "signkin.annotation",
    "Interval": "signkin.annotation",
    "Recording": "signkin.recording",
    "SignkinError": "signkin.errors",
    "read_annotation": "signkin.io",
    "read_recording": "signkin.io",
}


def __getattr__(name: str) -> Any:
    # Imported on first use: a job that wants one module does not pay for all readers.
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'signkin' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
