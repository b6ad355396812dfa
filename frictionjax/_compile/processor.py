"""Which processor this is: compiled programs use what it can do."""

import platform
import subprocess
from pathlib import Path

_CORES = Path("/proc/cpuinfo")
_TELL = "model name", "flags", "Features", "CPU part"


def processor() -> str:
    """Its name and, where the system tells, what it can do."""
    found = [platform.machine(), platform.processor()]
    if _CORES.exists():
        core = _CORES.read_text(errors="replace").partition("\n\n")[0]
        found += [line for line in core.splitlines() if line.startswith(_TELL)]
    elif platform.system() == "Darwin":
        name = "sysctl", "-n", "machdep.cpu.brand_string"
        found.append(subprocess.run(name, capture_output=True, text=True).stdout)
    return "\n".join(found)
