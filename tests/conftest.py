"""What all tests share."""

from __future__ import annotations

import signal

import pytest


def pytest_configure() -> None:
    """Ctrl-C raises KeyboardInterrupt, as at a prompt: a shell that runs pytest in the background has it ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The long searches over all kinds of numbers last: they take hours, and the others are to have their turn."""
    items.sort(key=lambda item: "conformance" in item.path.parts)
