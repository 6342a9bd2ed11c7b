"""A progress bar for what lasts, by tqdm where it is installed."""

from __future__ import annotations

import sys
import time
import warnings
from typing import Any, Optional

PATIENCE = 0.5  # seconds


class Progress:
    """`report(done)` is called now and then. Unless asked for, nothing is shown of what is over soon."""

    def __init__(self, total: int, wanted: Optional[bool], what: str = "problems") -> None:
        self._total = total
        self._what = what
        self._wanted = wanted
        self._start = time.monotonic()
        self._bar: Any = None
        self._is_off = wanted is False or (wanted is None and not (sys.stderr.isatty() or "ipykernel" in sys.modules))

    def report(self, done: int) -> None:
        """So many are done."""
        if self._is_off:
            return
        if self._bar is None:
            if self._wanted is None and time.monotonic() - self._start < PATIENCE:
                return
            self._bar = self._new_bar()
            if self._bar is None:
                return
        self._bar.update(done - self._bar.n)

    def _new_bar(self) -> Any:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of notebooks without widgets: the bar is text then
                from tqdm.auto import tqdm
        except ImportError:
            self._is_off = True
            return None
        return tqdm(total=self._total, unit=f" {self._what}")

    def __enter__(self) -> "Progress":
        if self._wanted:
            self.report(0)  # who asks for a bar sees one, however soon it is over
        return self

    def __exit__(self, kind: Any, *rest: Any) -> None:
        if self._bar is not None:
            if kind is None:
                self._bar.update(self._total - self._bar.n)
            self._bar.close()
