"""Sliders and canvas in the browser, numbers here: what goes to and fro between them."""

import base64
import threading
from pathlib import Path
from typing import Any

import anywidget
import traitlets

from .explored import Explored, explored_at
from .newest import NewestOnly
from .setting import SLIDERS, PageSetting
from .still import draw_still

_Asked = tuple[str, PageSetting]


class ExplorePage(anywidget.AnyWidget):
    """The page of `explore`.

    The browser sends where its sliders have been since it last did, in that order, and the
    name of the view that they are in. Back go, for each place, `arrays`
    (`Explored.packed`) and `told`: that name (none where Python moved the sliders), the
    setting, whether it went well and the status; sizes of the arrays, their eps and
    coefficients.
    """

    _esm = Path(__file__).with_name("page.js")
    _css = Path(__file__).with_name("page.css")

    angle = traitlets.Float()
    slope = traitlets.Float()
    asymmetry = traitlets.Float()
    eps = traitlets.Float()
    gamma = traitlets.Float()
    sliders: Any = traitlets.List().tag(sync=True)
    arrays = traitlets.Bytes().tag(sync=True)
    told = traitlets.Dict().tag(sync=True)

    def __init__(self, shown: Explored):
        self._answering = threading.RLock()
        self._newest = NewestOnly[_Asked](self._answer)
        self._serial = 0
        self._asked = shown.setting
        self.shown = shown
        super().__init__(
            **shown.setting._asdict(), sliders=[slider.sent() for slider in SLIDERS]
        )
        self._tell("", shown.setting, shown, shown.status.message)
        self.on_msg(self._heard)
        self.observe(self._moved, names=list(PageSetting._fields))

    def __repr__(self) -> str:
        values = ", ".join(f"{k}={v:.6g}" for k, v in self._asked._asdict().items())
        return f"ExplorePage({values}: {self.status})"

    @property
    def status(self) -> str:
        """Whether what is shown can be trusted, or why it is not what the sliders say."""
        return self.told["status"]

    def still(self) -> Any:
        """The picture of what is shown, by matplotlib.

        >>> figure = fx.explore().still()
        >>> [text.get_text() for text in figure.axes[2].texts]
        ['0.2010 N', '0.0991 N', '2.029']
        """
        return draw_still(self.shown, "" if self.told["ok"] else self.status)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        data, metadata = super()._repr_mimebundle_(**kwargs)
        picture = base64.b64encode(self.still()._repr_png_()).decode()
        return data | {"image/png": picture}, metadata

    def _heard(self, _: Any, content: Any, buffers: Any) -> None:
        view = str(content["view"])
        settings = [
            PageSetting(*(float(setting[name]) for name in PageSetting._fields))
            for setting in content["settings"]
        ]
        self._newest.ask([(view, setting) for setting in settings])

    def _moved(self, change: Any) -> None:
        """Python has moved sliders: answered at once, before the next line runs."""
        setting = PageSetting(*(getattr(self, name) for name in PageSetting._fields))
        if setting != self._asked:
            self._newest.ask([])  # where sliders were before that
            self._answer(("", setting))

    def _answer(self, request: _Asked) -> None:
        view, setting = request
        with self._answering:
            self._asked = setting
            found, status = None, ""
            try:
                found = explored_at(setting)
                status = found.status.message
            except ValueError as refused:
                status = str(refused)
            with self.hold_trait_notifications():
                for name, value in setting._asdict().items():
                    setattr(self, name, value)
            self._tell(view, setting, found, status)

    def _tell(
        self, view: str, setting: PageSetting, found: Explored | None, status: str
    ) -> None:
        good = found is not None and found.status == 0
        self._serial += 1
        told = {
            "serial": self._serial,
            "view": view,
            "ok": good,
            "status": status,
            "setting": setting._asdict(),
        }
        with self.hold_sync():
            if found is not None and good:
                self.shown = found
                self.arrays = found.packed()
            shown = self.shown
            self.told = told | {
                "wells": shown.wells.size,
                "times": shown.ts.size,
                "eps": shown.setting.eps,
                "coefficients": shown.coefficients,
            }
