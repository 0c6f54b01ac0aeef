"""The kind of machine that figures come from."""

from __future__ import annotations

import platform
from pathlib import Path


def machine() -> str:
    """Processor, how many of them, system."""
    name = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.is_file():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), name)
        name += f", {sum(line.startswith('processor') for line in lines)} processors"
    return f"{name}, {platform.system()} {platform.machine()}"
