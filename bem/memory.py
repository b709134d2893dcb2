"""Memory available to this process."""

from __future__ import annotations

import math
from pathlib import Path


def available_memory() -> float:
    """Memory that this process may still allocate [bytes].

    The smallest of the machine's available memory and what is left of the control group's limit (either version).
    """
    limits = [math.inf]
    try:
        with open("/proc/meminfo") as file:
            for line in file:
                if line.startswith("MemAvailable:"):
                    limits.append(float(line.split()[1]) * 1024)
    except (OSError, ValueError):
        pass
    for limit, usage in (
        ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
        ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"),
    ):
        try:
            limits.append(float(Path(limit).read_text()) - float(Path(usage).read_text()))
        except (OSError, ValueError):
            continue
    return max(min(limits), 0.0)
