"""A throw-away virtual environment with the peers in it, and one core for all of them."""

import os
import subprocess
import sys
import venv
from pathlib import Path

REQUIREMENTS = Path(__file__).with_name("requirements.txt")


def enter(folder: Path) -> None:
    """Goes on in the virtual environment in a folder, which is made when it is not there or not up to date."""
    if Path(sys.prefix).resolve() == folder.resolve():
        return
    python = folder / "bin" / "python"
    installed = folder / "installed.txt"
    wanted = REQUIREMENTS.read_text()
    if not installed.exists() or installed.read_text() != wanted:
        print(f"Installing {', '.join(_pins())} in {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True)
        install: list[str | Path] = [python, "-m", "pip", "install", "--quiet", "--prefer-binary", "-r", REQUIREMENTS]
        subprocess.run(install, check=True, stdout=sys.stderr)
        installed.write_text(wanted)
    os.execv(python, [str(python), *sys.argv])


def stay_on(core: int) -> None:
    """Binds this process, and all that it starts, to one core."""
    os.sched_setaffinity(0, {core})


def last_core() -> int:
    """The last core that this process may use: the first ones tend to serve interrupts."""
    return max(os.sched_getaffinity(0))


def machine() -> dict[str, str]:
    """What the figures depend on, apart from the programs."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    return {
        "processor": f"{os.cpu_count()} × {models[0] if models else 'unknown'}",
        "system": f"{os.uname().sysname} {os.uname().release}",
        "load": load,
        "python": sys.version.split()[0],
    }


def _pins() -> list[str]:
    lines = REQUIREMENTS.read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]
