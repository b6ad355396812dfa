"""What a scene without effects compiles: `python plain_programs.py blocked`, or `after`.

Prints a line for each program of a solve and of its limit, with the digest of its jaxpr,
and digests of what came out. `blocked`: no module that only effects need can be imported;
`after`: a scene with each effect has been solved in the process.
"""

import hashlib
import re
import sys

import jax

THEIRS = "stochastic", "turning", "rods", "contact", "wiggly.inertial", "wiggly.turning"


class Blocked:
    """No module of theirs is to be found."""

    def find_spec(self, name, path=None, target=None):
        if any(f"{name}.".startswith(f"frictionjax.{each}.") for each in THEIRS):
            raise ImportError(f"{name} is only for effects")


def digest(text):
    """Without the addresses that functions are named by."""
    return hashlib.sha256(re.sub(r" at 0x[0-9a-f]+", "", text).encode()).hexdigest()[:16]


class Programs:
    """Jaxprs of compiled functions, by name and shapes, and which of them were called."""

    def __init__(self):
        from frictionjax._compile import programs

        self.jaxprs = {}
        self.called = set()
        self._kept, programs.kept = programs.kept, self._recorded

    def _recorded(self, fn, run, structure, rest, options):
        program = self._kept(fn, run, structure, rest, options)

        def call(numbers):
            shapes = tuple(getattr(x, "shape", ()) for x in numbers)
            known = f"{fn.__module__}.{fn.__name__}", hash((structure, shapes))
            self.called.add(known)
            if known not in self.jaxprs:
                self.jaxprs[known] = digest(str(jax.make_jaxpr(run)(numbers)))
            return program(numbers)

        return call


def solve_with_each_effect():
    import frictionjax as fx
    from frictionjax.io.example_scenes import example_text
    from frictionjax.io.scene_files import parse_scene

    rod = parse_scene(example_text("nap-flip"), "nap-flip").scene
    fx.solve(rod, 0.05, ts=[0.1, 0.2])
    for effect in (  # those with loops of their own before those that share the plain one
        fx.effects.Inertia(1e-5),
        fx.effects.Noise(1e-3),
        fx.effects.LeadingOrder(),
        fx.effects.RigidArray([0.0, 0.2]),
        fx.effects.CompliantArray([0.0, 0.2]),
    ):
        key = 0 if isinstance(effect, fx.effects.Noise) else None
        fx.solve(plain_scene().replace(effects=(effect,)), 0.05, ts=[0.5, 1.0], key=key)
    held = rod.replace(effects=(fx.effects.AxialLoad(10.0),))
    fx.solve(held, 0.05, ts=[0.1, 0.2])


def plain_scene():
    import frictionjax as fx

    bristle = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4)
    support, load = fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0)
    return fx.Scene(fx.profiles.Sine(0.1), bristle, support, load, 3.0)


def main(how):
    jax.config.update("jax_enable_x64", True)
    if how == "blocked":
        sys.meta_path.insert(0, Blocked())
    import frictionjax as fx

    fx.use_fast_cpu()
    programs = Programs()
    if how == "after":
        solve_with_each_effect()
        programs.called.clear()
    found, limit = fx.solve(plain_scene(), 0.02), fx.solve_limit(plain_scene())
    for known in sorted(programs.called):
        print(known[0], programs.jaxprs[known])
    for values in (found.z, limit.z, found.dissipation):
        print(digest(str(jax.device_get(values).tobytes())))


if __name__ == "__main__":
    main(sys.argv[1])
