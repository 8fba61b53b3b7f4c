"""The frame around a workflow script: its log, its warnings, its errors.

A user's error ends the job with one sentence on the terminal and in the log;
anything else leaves its traceback in both.
"""

from __future__ import annotations

import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from signkin.errors import SignkinError
from signkin.results.written import record


@contextmanager
def job(snakemake: Any) -> Iterator[None]:
    """Send what the script prints to the rule's log, and its errors to the terminal as well."""
    terminal = sys.stderr
    log_path = Path(snakemake.log[0])
    log_path.parent.mkdir(parents=True, exist_ok=True)
    with (
        log_path.open("w", encoding="utf-8", buffering=1) as log,
        redirect_stdout(log),
        redirect_stderr(log),
    ):
        warnings.simplefilter("default")
        try:
            yield
            record(snakemake.output)
        except SignkinError as error:
            print(f"signkin: {error}", file=log)
            print(f"\nsignkin: {error}\n", file=terminal)
            sys.exit(1)
        except Exception:
            text = traceback.format_exc()
            print(text, file=log)
            print(f"\n{text}", file=terminal)
            sys.exit(1)
