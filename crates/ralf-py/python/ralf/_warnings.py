"""What callers are warned of."""

from __future__ import annotations

import warnings


def warn_of(sentences: list[str]) -> None:
    """Warn the caller's caller."""
    for sentence in sentences:
        warnings.warn(sentence, stacklevel=3)
