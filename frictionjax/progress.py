"""A bar on standard error."""

from tqdm import tqdm

_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed} so far, {remaining} to go"


def progress_bar(name: str, shown: bool) -> tqdm:
    """A bar from 0 to 1 for `with`."""
    return tqdm(total=1.0, disable=not shown, bar_format=_FORMAT, desc=name)
