"""How long a release takes, cold and warm, and how long `ik` takes to answer: whole processes, as a user feels them.

Run: `make bench`. Prints a table; asserts nothing, since wall time depends on the machine.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

COMMAND = [sys.executable, "-m", "linkwright.app"]


def seconds(arguments: list[str], cache: Path) -> float:
    """Wall time of one process with this part cache."""
    environment = {**os.environ, "LINKWRIGHT_CACHE": str(cache)}
    start = time.perf_counter()
    subprocess.run([*COMMAND, *arguments], env=environment, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder) / "cache"
        rows = [
            ("release hit, empty part cache", seconds(["release", "hit", "-o", f"{folder}/hit"], cache)),
            ("release hit, warm part cache", seconds(["release", "hit", "-o", f"{folder}/hit"], cache)),
            ("check hit, warm part cache", seconds(["check", "hit"], cache)),
            ("ik hit, one pose", seconds(["ik", "hit", "--pose", "0,0,260,0,0,0"], cache)),
            ("show hit", seconds(["show", "hit"], cache)),
        ]
    for what, took in rows:
        print(f"{what:<34} {took:7.2f} s")


if __name__ == "__main__":
    main()
