"""config.yaml as typed, frozen sections, checked before anything runs."""

from signkin.settings.checks import load_settings
from signkin.settings.sections import Settings

__all__ = ["Settings", "load_settings"]
