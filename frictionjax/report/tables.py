"""Plain-text tables with aligned columns."""

from .._checks import as_text
from .._text import in_columns
from ..coefficients import COEFFICIENTS, OF_THE_BRISTLE, meaning_of
from ..measured import RowCoefficients

_NOISE = (
    "(std: of a single row. Noise adds to the extreme slopes of a row, so the mean over\n"
    "rows lies above the friction of the mean profile, which is the one above.)"
)
_NOISE_OF_ROW = (
    "(std: of a single row. All rows with this one period; the friction above is that of\n"
    "row {row} alone. Noise adds to the extreme slopes of each.)"
)
_FITTED = ("explained", "", "share of the variance that is periodic")


def row_table(rows: RowCoefficients, row: int | None = None) -> str:
    """Friction over the rows of a map: mean and standard deviation of a row.

    `row`: whose friction stands above, None where it is that of the mean profile.
    """
    mean, std = rows.mean, rows.std
    lines = [
        (
            name,
            as_text(mean[name]),
            f"{std[name]:.2g}",
            unit,
            meaning_of(name, meaning, mean.get("alpha", 0.0) < 0),
        )
        for name, unit, meaning in (*COEFFICIENTS, _FITTED)
        if name not in OF_THE_BRISTLE
    ]
    header = ("coefficient", "mean", "std", "unit", "meaning")
    said = _NOISE if row is None else _NOISE_OF_ROW.format(row=row)
    count = f"{len(rows.used)} rows, period {rows.period:.4g} m"
    text = [f"{count}\n{in_columns(header, lines, left=1, meanings=2)}", said]
    if rows.refused:
        text.append(f"{len(rows.refused)} rows left out, not admissible for the bristle:")
        text += [f"  row {index}: {why}" for index, why in rows.refused.items()]
    return "\n".join(text)
