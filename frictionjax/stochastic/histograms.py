"""How paths are spread at one time, beside Boltzmann's density."""

from typing import TYPE_CHECKING, Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int
from scipy import special

from .._checks import kind_of, require, require_numbers, with_nan
from ..effects import Engine, Noise, noise_among
from ..model import Scene, scene_for
from .boltzmann import AtRest, boltzmann_shares, energies_at_rest
from .settings import SETTINGS

if TYPE_CHECKING:
    import xarray as xr

_SHARE = f"{SETTINGS.confidence:.0%}"
_MEANING = {
    "count": ("1", "paths in a bin"),
    "density": ("1/m", "share of the paths in a bin over its width"),
    "density_low": ("1/m", f"lower end of the {_SHARE} interval (Clopper and Pearson)"),
    "density_high": ("1/m", f"upper end of the {_SHARE} interval (Clopper and Pearson)"),
    "boltzmann": ("1/m", "mean over a bin of Boltzmann's density at this load"),
    "boltzmann_density": ("1/m", "Boltzmann's density at this load"),
    "z": ("m", "middle of a bin"),
    "z_left": ("m", "left end of a bin"),
    "z_right": ("m", "right end of a bin"),
    "z_fine": ("m", "state of a tip"),
    "bin": (None, "number of the bin"),
}


class Spread(NamedTuple):
    """How far counts are from what they are expected to be: Pearson's chi^2, its degrees of
    freedom, and how often chance alone takes it as far."""

    chi_square: float
    degrees: int
    p_value: float


@with_nan
def histogram(
    scene: Scene, paths: "xr.Dataset", time: Any = None, bins: Any = 40
) -> "xr.Dataset":
    """How paths of `fx.ensemble` are spread at one time, beside Boltzmann's density.

    `paths`: the data set that `fx.ensemble` made of this `scene`; `time`: one of its times
    in s, the last where None; `bins`: how many, evenly between the outermost paths, or
    their rising edges in m, shape (n + 1,). Paths that failed are left out.

    Returns a data set over `bin`: `count`, `density` (1/m) and its 95% interval
    `density_low`, `density_high` (Clopper and Pearson's: never too narrow), `boltzmann`,
    the mean over each bin of `exp(-(Phi + V_eps - l z)/T_eps)/Z` at the load of that time,
    by quadrature; over `z_fine` that density itself. Attributes: `chi_square` of the counts
    against Boltzmann's, its `degrees` of freedom and its `p_value`, bins with fewer than 5
    expected paths taken together (NaN where that leaves one). Paths have Boltzmann's
    density where the load has stood still for long; else the difference tells how far they
    are from rest.

    Raises `ValueError` for arguments out of range, a scene without noise, and a data set
    that `ensemble` has not made.

    Source: C. J. Clopper and E. S. Pearson, Biometrika 26, 404 (1934).

    >>> noisy = scene.replace(effects=(fx.effects.Noise(temperature=1e-3),))
    >>> ts = [0.0, 0.75, 3.0]
    >>> paths = fx.ensemble(noisy, eps=0.1, gamma=1.0, ts=ts, paths=100, key=0)
    >>> shares = fx.histogram(noisy, paths, bins=4)
    >>> shares["count"].values
    array([ 6, 23, 52, 19])
    """
    scene = scene_for(Engine.ENSEMBLE, scene)
    noise = noise_among(scene.effects)
    names = [type(effect).__name__ for effect in scene.effects]
    require(noise is not None, "scene.effects", names, "effects.Noise among them")
    moment, z = _paths_at(paths, time)
    edges = _edges(bins, z)
    rest = _at_rest(scene, noise, moment, paths.attrs)
    return _data_set(rest, z, edges, {"time": moment, "gamma": paths.attrs["gamma"]})


def _paths_at(paths: Any, time: Any) -> tuple[float, Float[np.ndarray, " paths"]]:
    """A time of the data set in s, and where the good paths are then."""
    ours = {"z", "status"} <= set(getattr(paths, "data_vars", ()))
    ours = ours and {"eps", "gamma"} <= set(paths.attrs) and "path" in paths.dims
    require(ours, "paths", kind_of(paths), "a data set that ensemble has made")
    known = np.asarray(paths.time.values)
    if time is None:
        place = known.size - 1
    else:
        require_numbers("time", time, "one time in s", lambda t: t.ndim == 0)
        place = int(np.argmin(np.abs(known - float(time))))
        held = np.isclose(known[place], float(time), rtol=1e-9, atol=0.0)
        require(held, "time", time, f"one of the {known.size} times of paths")
    z = paths.z.transpose("path", "time").values[:, place]
    z = z[paths.status.values == 0]
    require(z.size > 0, "paths", "all failed", "one that did not")
    return float(known[place]), z


def _edges(bins: Any, z: Float[np.ndarray, " paths"]) -> Float[np.ndarray, " edges"]:
    needs = "how many, at least 1, or their rising edges in m"
    require_numbers("bins", bins, needs, lambda b: np.isfinite(b))
    asked = np.asarray(bins, dtype=float)
    if asked.ndim == 0:
        count = float(asked)
        require(count >= 1 and count == round(count), "bins", bins, needs)
        ends = float(np.min(z)), float(np.max(z))
        margin = 0.5 * max(float(np.ptp(z)), 1e-12 * float(np.max(np.abs(z))), 1e-300)
        middle = 0.5 * sum(ends)
        edges = np.linspace(middle - margin, middle + margin, int(count) + 1)
        # Rounded, the outermost would be a rounding beyond.
        edges[0], edges[-1] = min(edges[0], ends[0]), max(edges[-1], ends[1])
        return edges
    rising = asked.ndim == 1 and asked.size > 1 and np.all(np.diff(asked) > 0)
    require(rising, "bins", bins, needs)
    return asked


def _at_rest(scene: Scene, noise: Noise | None, time: float, numbers: dict) -> AtRest:
    assert noise is not None
    eps = float(numbers["eps"])
    return AtRest(
        potential=scene.potential,
        support=scene.support,
        load=float(scene.load(jnp.asarray(time))),
        eps=eps,
        temperature=float(noise.temperature_at(eps)),
    )


def _share_interval(
    counts: Int[np.ndarray, " bins"], total: int
) -> tuple[np.ndarray, np.ndarray]:
    """Between which the share of each bin is, with 95% confidence."""
    outside = 0.5 * (1 - SETTINGS.confidence)
    low = special.betaincinv(np.maximum(counts, 1), total - counts + 1, outside)
    high = special.betaincinv(counts + 1, np.maximum(total - counts, 1), 1 - outside)
    return np.where(counts > 0, low, 0.0), np.where(counts < total, high, 1.0)


def spread_of_counts(
    counts: Int[np.ndarray, " bins"], shares: Float[np.ndarray, " bins"], total: int
) -> Spread:
    """Of `total` paths, those outside of all bins too; rare bins are one."""
    seen = np.append(counts, total - np.sum(counts)).astype(float)
    expected = total * np.append(shares, max(1 - float(np.sum(shares)), 0.0))
    rare = expected < SETTINGS.least_expected
    seen = np.append(seen[~rare], np.sum(seen[rare]))
    expected = np.append(expected[~rare], np.sum(expected[rare]))
    if expected[-1] < SETTINGS.least_expected and expected.size > 1:
        smallest = int(np.argmin(expected[:-1]))
        for values in (seen, expected):
            values[smallest] += values[-1]
        seen, expected = seen[:-1], expected[:-1]
    degrees = expected.size - 1
    if degrees < 1:
        return Spread(0.0, 0, np.nan)
    chi_square = float(np.sum((seen - expected) ** 2 / expected))
    return Spread(chi_square, degrees, float(special.chdtrc(degrees, chi_square)))


def _data_set(
    rest: AtRest,
    z: Float[np.ndarray, " paths"],
    edges: Float[np.ndarray, " edges"],
    numbers: dict[str, float],
) -> "xr.Dataset":
    import xarray as xr

    counts, _ = np.histogram(z, edges)
    width = np.diff(edges)
    low, high = _share_interval(counts, z.size)
    known = boltzmann_shares(rest, edges)
    fine = np.linspace(edges[0], edges[-1], SETTINGS.fine)
    density = np.exp((known.level - energies_at_rest(rest, fine)) / rest.temperature)
    columns = {
        "count": counts,
        "density": counts / (z.size * width),
        "density_low": low / width,
        "density_high": high / width,
        "boltzmann": known.shares / width,
    }
    middles = 0.5 * (edges[1:] + edges[:-1])
    data = xr.Dataset(
        {name: ("bin", values) for name, values in columns.items()}
        | {"boltzmann_density": ("z_fine", density)},
        coords={
            "bin": np.arange(width.size),
            "z": ("bin", middles),
            "z_left": ("bin", edges[:-1]),
            "z_right": ("bin", edges[1:]),
            "z_fine": fine,
        },
    )
    for name, (units, meaning) in _MEANING.items():
        data[name].attrs = {"long_name": meaning} | ({"units": units} if units else {})
    spread = spread_of_counts(counts, known.shares, z.size)
    bath = {"eps": rest.eps, "load": rest.load, "thermal_energy": rest.temperature}
    told = numbers | bath | {"paths": z.size} | spread._asdict()
    return data.assign_attrs(title="Paths beside Boltzmann's density", **told)
