"""Surfaces designed for a ratio of friction, on the dynamics at eps = 1e-4, gamma = 1.

`python benchmarks/design_dynamics.py` prints Markdown. `fx.fit_profile` for each bristle
and ratio, then `fx.solve` under a ramp to the right and one to the left: mean force of ten
slips after thirty, from what they dissipate. `slide`: the ratio of `fx.steady_slide`.
"""

import jax
import numpy as np

import frictionjax as fx

jax.config.update("jax_enable_x64", True)

EPS, RATE, WAIT, SLIPS = 1e-4, 1.0, 30, 10
RATIOS = (1.5, 3.0, 8.0)
# A bristle, and the friction to the left that is asked for, N.
BRISTLES = {
    "homothetic": (fx.bristles.Homothetic(1.0), 0.1),
    "vertical": (fx.bristles.VerticalSpring(1.0, 2.0, 1.0), 0.1),
    "slanted": (fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5), 0.1),
    "angular": (fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3), 0.03),
}


def mean_force(profile, bristle, side):
    """Of ten slips, N, by `solve`; `side` 1 or -1."""
    law = fx.friction(profile, bristle)
    begin = max(float(law.rho_plus), -float(law.rho_minus)) / RATE + WAIT * EPS / RATE
    ts = begin + EPS / RATE * np.array([0.0, SLIPS])
    ramp, spring = fx.loads.Ramp(side * RATE), fx.supports.Spring(1.0)
    scene = fx.Scene(profile, bristle, spring, ramp, duration=float(ts[-1]))
    found = fx.solve(scene, EPS, 1.0, ts=ts, accuracy=1e-4)
    assert found.ok
    return side * float(np.diff(found.dissipation)[0] / abs(np.diff(found.z)[0]))


def main():
    print("| bristle | ratio asked for | fit | solve | gap | slide | gap |")
    print("|---|---|---|---|---|---|---|")
    for name, (bristle, left) in BRISTLES.items():
        for ratio in RATIOS:
            fit = fx.fit_profile(fx.Target(bristle, ratio * left, -left), harmonics=16)
            if not fit.success:
                print(f"| {name} | {ratio:g} | {fit.status.name} | | | | |", flush=True)
                continue
            profile = fit.profile
            shown = -mean_force(profile, bristle, 1) / mean_force(profile, bristle, -1)
            slide = fx.steady_slide(profile, bristle, EPS, 1.0, RATE)
            steady = float(slide.ratio) if slide.ok else float("nan")
            gaps = shown / ratio - 1, steady / ratio - 1
            both = f"{shown:.5g} | {gaps[0]:+.3%} | {steady:.5g} | {gaps[1]:+.3%}"
            print(f"| {name} | {ratio:g} | {fit.status.name} | {both} |", flush=True)


if __name__ == "__main__":
    main()
