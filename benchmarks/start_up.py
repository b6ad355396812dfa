"""What a process waits for before it can begin: imports, first calls, the shell's help.

`python benchmarks/start_up.py` prints medians over new processes, in seconds: the wall's
and those of the CPU, compilers' threads included. What Python itself takes to start is left
out of imports and calls, not of the shell's commands. `nothing kept` has an empty folder
for compiled programs each time, `kept` one that a run before has filled.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HOME = Path(__file__).resolve().parents[1]
TIMED = """
import time
wall, cpu = time.perf_counter(), time.process_time()
{code}
print(time.perf_counter() - wall, time.process_time() - cpu)
"""
LIBRARY = """
import jax
jax.config.update("jax_enable_x64", True)
import frictionjax as fx
fx.use_fast_cpu()
fx.keep_compiled()
surface = fx.profiles.Sine(0.1)
bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
"""
FRICTION = LIBRARY + "float(fx.friction(surface, bristle).rho_plus)"
SOLVE = (
    LIBRARY
    + """
support, load = fx.supports.Spring(1.0), fx.loads.Sine(1.05, 3.0)
scene = fx.Scene(surface, bristle, support, load, duration=3.0)
float(fx.solve(scene, eps=1e-3).z[-1])
"""
)
IMPORTS = {
    "`import frictionjax`": "import frictionjax",
    "`from frictionjax.cli import main`": "from frictionjax.cli import main",
    "`import jax`, for comparison": "import jax",
}
COMMANDS = {
    "`frictionjax --version`": ["--version"],
    "`frictionjax --help`": ["--help"],
}
CALLS = {"`fx.friction`, with imports": FRICTION, "`fx.solve`, with imports": SOLVE}


def run(cache, *arguments):
    """What a new process prints, and its seconds: the wall's and those of the CPU."""
    # As installed, with the source compiled once, whatever the shell around says.
    env = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    env |= {"PYTHONPATH": str(HOME), "XDG_CACHE_HOME": str(cache)}
    before, started = os.times(), time.perf_counter()
    done = subprocess.run(
        [sys.executable, *arguments], env=env, capture_output=True, text=True, cwd=cache
    )
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    wall, after = time.perf_counter() - started, os.times()
    cpu = after.children_user + after.children_system
    return done.stdout, (wall, cpu - before.children_user - before.children_system)


def timed(code, cache):
    """Seconds of a piece of code in a new process."""
    out, _ = run(cache, "-c", TIMED.format(code=code))
    return tuple(float(word) for word in out.split()[-2:])


def timed_anew(code):
    """The same, with nothing kept from before."""
    with tempfile.TemporaryDirectory() as cache:
        return timed(code, cache)


def measured(repeats, cache):
    """Name and seconds, shape (repeats, 2), of each row."""
    for name, code in IMPORTS.items():
        yield name, [timed(code, cache) for _ in range(repeats)]
    for name, options in COMMANDS.items():
        told = "-m", "frictionjax", *options
        yield name, [run(cache, *told)[1] for _ in range(repeats)]
    for name, code in CALLS.items():
        yield f"{name}, nothing kept", [timed_anew(code) for _ in range(repeats)]
        timed(code, cache)
        yield f"{name}, kept", [timed(code, cache) for _ in range(repeats)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    print("| | s | CPU s |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as cache:
        for name, seconds in measured(options.repeats, cache):
            wall, cpu = (statistics.median(column) for column in zip(*seconds, strict=True))
            print(f"| {name} | {wall:.2g} | {cpu:.2g} |", flush=True)


if __name__ == "__main__":
    main()
