"""Frames a second of the page of sliders, `fx.explore`.

`python benchmarks/explore.py` drags each slider through 200 values and times what Python
does for a frame, from the browser's message to bytes that are ready to go: new numbers,
checked, solved, packed. `--browser` also draws such frames on the page's canvas in Chromium
without a window (the extra `browser`), one after the other as Python moves the sliders.
`--kernel` sends the same places to a Jupyter kernel, one after the other, and then 60 a
second, in the ten messages that the page would send, whatever comes back: how many are
answered, how many dropped, how late answers are. (JupyterLab itself, with its page and its
server: `pytest -n 0 -s -m slow tests/explore/test_page_in_jupyterlab.py`.)
"""

import argparse
import base64
import shutil
import threading
import time
from pathlib import Path

import jax
import numpy as np

import frictionjax as fx
from frictionjax.explore.setting import SLIDERS, PageSetting

PAGE = Path(fx.explore.__code__.co_filename).parent
ENDS = {"angle": (-1.1, 1.1)}  # of what is allowed throughout
# A model as `anywidget` hands it to the page, that answers unasked, by recorded frames.
MODEL = """async ([script, style, frames]) => {
  const sheet = document.createElement("style");
  sheet.textContent = style;
  document.head.append(sheet);
  const url = URL.createObjectURL(new Blob([script], {type: "text/javascript"}));
  const page = (await import(url)).default;
  const arrays = frames.map(frame =>
    new DataView(Uint8Array.from(atob(frame.arrays), c => c.charCodeAt(0)).buffer));
  let [at, heard] = [0, null];
  const model = {
    get: name => name === "arrays" ? arrays[at] : frames[at][name],
    on: (_, fn) => { heard = fn; }, off: () => {}, send: () => {},
  };
  page.render({model, el: document.body});
  const canvas = document.querySelector("canvas");
  const waits = [];
  for (let i = 0; i < 200; i++) {
    const [before, drawn] = [performance.now(), Number(canvas.dataset.frames || 0)];
    at = (at + 1) % frames.length;
    heard();
    while (Number(canvas.dataset.frames || 0) === drawn)
      await new Promise(requestAnimationFrame);
    waits.push(performance.now() - before);
  }
  return waits;
}"""


def drag(page, name, count):
    """Seconds of each of `count` frames while a slider goes from end to end."""
    slider = next(one for one in SLIDERS if one.name == name)
    low, high = ENDS.get(name, (slider.low, slider.high))
    spaced = np.geomspace if slider.logarithmic else np.linspace
    seconds, frames, start = [], [], PageSetting()._asdict()
    for value in spaced(low, high, count):
        content = {"view": "benchmark", "settings": [start | {name: float(value)}]}
        before = time.perf_counter()
        page._heard(page, content, [])
        page._newest.wait()
        seconds.append(time.perf_counter() - before)
        assert page.told["ok"], page.status
        frames.append((dict(page.told), page.arrays))
    return np.array(seconds), frames


def drawn_in_browser(frames):
    """Seconds from an answer to the frame that is drawn, 200 times."""
    from playwright.sync_api import sync_playwright

    sliders = [one.sent() for one in SLIDERS]
    sent = [
        {"told": told, "arrays": base64.b64encode(arrays).decode(), "sliders": sliders}
        for told, arrays in frames
    ]
    script, style = (PAGE / "page.js").read_text(), (PAGE / "page.css").read_text()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        page = browser.new_page(viewport={"width": 1100, "height": 700})
        waits = page.evaluate(MODEL, [script, style, sent])
        browser.close()
    return 1e-3 * np.array(waits)


OPEN = """
import jax
jax.config.update("jax_enable_x64", True)
import frictionjax as fx
fx.use_fast_cpu()
fx.keep_compiled()
page = fx.explore()
print(page.model_id)
"""


class Kernel:
    """A page in a Jupyter kernel, as a browser talks to it."""

    def __init__(self):
        from jupyter_client.manager import start_new_kernel

        self._manager, self._client = start_new_kernel(kernel_name="python3")
        self._client.execute(OPEN)
        self._page = self._next("stream")["text"].strip()

    def close(self):
        self._manager.shutdown_kernel(now=True)

    def _next(self, kind):
        while True:
            message = self._client.get_iopub_msg(timeout=120)
            if message["msg_type"] == "error":
                raise RuntimeError(message["content"]["evalue"])
            if message["msg_type"] == kind:
                return message["content"]

    def ask(self, angles):
        settings = [PageSetting(angle=float(angle))._asdict() for angle in angles]
        content = {"view": "benchmark", "settings": settings}
        data = {"comm_id": self._page, "data": {"method": "custom", "content": content}}
        message = self._client.session.msg("comm_msg", data)
        self._client.shell_channel.send(message)

    def heard(self):
        """The angle of the next answer."""
        while True:
            state = self._next("comm_msg")["data"].get("state", {})
            if "told" in state:
                return state["told"]["setting"]["angle"]


def one_by_one(kernel, angles):
    """Seconds from each message to its answer."""
    seconds = []
    for angle in angles:
        before = time.perf_counter()
        kernel.ask([angle])
        assert kernel.heard() == angle
        seconds.append(time.perf_counter() - before)
    return np.array(seconds)


def in_a_hurry(kernel, angles, rate=60, together=6):
    """Places at a rate, answered or not: seconds between answers, and how late.

    A message goes when the last of its places is reached.
    """
    start = time.perf_counter()

    def send():
        for index in range(0, len(angles), together):
            some = angles[index : index + together]
            reached = start + (index + len(some) - 1) / rate
            time.sleep(max(0.0, reached - time.perf_counter()))
            kernel.ask(some)

    sender = threading.Thread(target=send)
    sender.start()
    times, late, angle = [start], [], None
    while angle != angles[-1]:
        angle = kernel.heard()
        times.append(time.perf_counter())
        late.append(times[-1] - start - np.searchsorted(angles, angle) / rate)
    sender.join()
    return np.diff(times), np.array(late)


def row(name, seconds):
    """A line of the table: medians, worst, frames a second by their sum."""
    median, worst = 1e3 * np.median(seconds), 1e3 * np.max(seconds)
    rate = len(seconds) / np.sum(seconds)
    print(f"| {name} | {median:.1f} | {worst:.1f} | {rate:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--browser", action="store_true")
    parser.add_argument("--kernel", action="store_true")
    options = parser.parse_args()
    jax.config.update("jax_enable_x64", True)
    fx.use_fast_cpu()
    fx.keep_compiled()
    before = time.perf_counter()
    page = fx.explore()
    print(f"first picture after {time.perf_counter() - before:.1f} s\n")
    print("| slider | median ms | worst ms | frames a second |\n|---|---|---|---|")
    for slider in SLIDERS:
        seconds, frames = drag(page, slider.name, options.count)
        row(slider.name, seconds)
        if slider.name == "angle":
            recorded = frames
    if options.kernel:
        angles = np.linspace(*ENDS["angle"], options.count)
        kernel = Kernel()
        one_by_one(kernel, angles[:5])
        row("angle, through a kernel", one_by_one(kernel, angles))
        between, late = in_a_hurry(kernel, angles)
        row("angle, 60 places a second", between)
        kernel.close()
    if options.browser:
        row("canvas alone, in Chromium", drawn_in_browser(recorded))
    if options.kernel:
        told = f"{late.size} of {angles.size} places answered, others dropped"
        print(f"\n{told}; late by {np.median(late):.2f} s, at most {late.max():.2f} s")


if __name__ == "__main__":
    main()
