"""Two virtual environments: irlx from this checkout, and the others, which want an older Pinocchio."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]

PEERS = (
    "pin==3.8.0",
    "pin-pink==4.4.0",
    "mink==1.3.0",
    "mujoco==4.0.0",
    "placo==0.10.2",
    "qpsolvers==4.13.0",
    "daqp==0.11.0",
    "quadprog==0.1.14",
)


def usual_folder() -> Path:
    """Where the environments are kept for the next time: in the user's cache."""
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "irlx" / "peers"


def environments(folder: Path) -> tuple[Path, Path]:
    """Python of irlx and of the others; what the folder lacks is installed, irlx itself always anew."""
    ours, theirs = folder / "irlx", folder / "others"
    _pip(ours, f"{CHECKOUT}[robots]")
    _pip(theirs, *PEERS)
    return _python(ours), _python(theirs)


def panda_urdf(python: Path) -> str:
    """Text of the Panda's URDF, as the data package of irlx's environment has it."""
    ask = "from irlx.cell.external import external_urdf; from irlx.diagnostics import Place; "
    ask += "print(external_urdf('panda', Place('panda')))"
    told = subprocess.run([str(python), "-c", ask], capture_output=True, text=True, check=True, env=clean())
    return told.stdout


def clean(*paths: Path) -> dict[str, str]:
    """Environment variables of what is started: one thread, and of Python's paths only these."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    kept |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return {**kept, "PYTHONPATH": os.pathsep.join(str(path) for path in paths)}


def _python(environment: Path) -> Path:
    return environment / "bin" / "python"


def _pip(environment: Path, *what: str) -> None:
    print(f"{environment}: {' '.join(what)}", file=sys.stderr, flush=True)
    if not _python(environment).exists():
        subprocess.run([sys.executable, "-m", "venv", str(environment)], check=True, env=clean())
    command = [str(_python(environment)), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*command, *what], check=True, env=clean(), stdout=sys.stderr)
