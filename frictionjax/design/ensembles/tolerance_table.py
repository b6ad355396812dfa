"""How friction spreads, as a table."""

import numpy as np
import xarray as xr

from ..._text import in_columns
from ...bristles import pulling_text
from ...wiggly import Status


class Tolerance:
    """How friction spreads; prints as a table.

    `data`: an `xarray.Dataset` over `quantity`: `nominal`, `mean`, `std` of the samples,
    `first_order` (std by the delta method), `quantiles`, all over admissible samples, and
    `samples` themselves, NaN where inadmissible; `unit`: of each quantity. `inadmissible`:
    their share. `flipped`: the share in which alpha, and with it the direction of friction,
    changed sign.
    """

    def __init__(self, data: xr.Dataset):
        self.data = data

    @property
    def inadmissible(self) -> float:
        """Share of samples in which the bristle cannot follow the surface."""
        return float(self.data.inadmissible)

    @property
    def flipped(self) -> float:
        """Share of samples that pull where the nominal part presses, or the other way."""
        return float(self.data.flipped)

    def __repr__(self) -> str:
        data = self.data
        names = ("nominal", "mean", "std", "first_order")
        heads = ["", *names, *(f"{q:.1%}" for q in data["quantile"].values)]
        rows = [heads]
        for name in data["quantity"].values:
            line = data.sel(quantity=name)
            numbers = [float(line[n]) for n in names] + line["quantiles"].values.tolist()
            rows.append([str(name), *(f"{v:.6g}" for v in numbers)])
        count = data.sizes["sample"]
        told = f"{count} samples, {self.inadmissible:.3%} inadmissible and left out"
        pulls = pulling_text(data.attrs["alpha"])
        other = "press on the surface" if pulls else "pull on the surface, alpha < 0"
        flipped = f", {self.flipped:.3%} {other}" if self.flipped else ""
        nominal = f"\nnominal {pulls}" if pulls else ""
        text = in_columns(rows[0], rows[1:])
        return f"{told}{flipped}{nominal}\n{text}{self._slides_in_words()}"

    def _slides_in_words(self) -> str:
        """How the steady slides spread, where they were asked for."""
        data = self.data
        if "slide_mean" not in data:
            return ""
        heads = ["", "nominal", "mean", "std"]
        rows = [[*heads, *(f"{q:.1%}" for q in data["quantile"].values)]]
        for name in data["force"].values:
            line = data.sel(force=name)
            numbers = [float(line[f"slide_{head}"]) for head in heads[1:]]
            numbers += line["slide_quantiles"].values.tolist()
            rows.append([str(name), *(f"{v:.6g}" for v in numbers)])
        lost = int(np.count_nonzero(data["status"].values != int(Status.OK)))
        told = f"Steady slides at eps = {data.attrs['eps']:.6g} m, {lost} without one"
        return f"\n{told}\n{in_columns(rows[0], rows[1:])}"
