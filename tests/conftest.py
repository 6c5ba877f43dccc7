"""What all tests share."""

from __future__ import annotations

import signal


def pytest_configure() -> None:
    """Ctrl-C raises KeyboardInterrupt, as at a prompt: a shell that runs pytest in the background has it ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
