"""Frames a second of the page of sliders, `fx.explore`.

`python benchmarks/explore.py` drags each slider through 200 values and times what Python
does for a frame, from the browser's message to bytes that are ready to go: new numbers,
checked, solved, packed. `--browser` also draws such frames on the page's canvas in
Chromium without a window (the extra `browser`), a slider being dragged once a frame.
"""

import argparse
import base64
import shutil
import time
from pathlib import Path

import jax
import numpy as np

import frictionjax as fx
from frictionjax.explore.setting import SLIDERS, PageSetting

PAGE = Path(fx.explore.__code__.co_filename).parent
ENDS = {"angle": (-1.1, 1.1)}  # of what is allowed throughout
# A model as `anywidget` hands it to the page, that answers from frames which were recorded.
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
    on: (_, fn) => { heard = fn; }, off: () => {},
    send: ({view}) => {
      at = (at + 1) % frames.length;
      frames[at].told.view = view;
      heard();
    },
  };
  page.render({model, el: document.body});
  const input = document.querySelector("input"), canvas = document.querySelector("canvas");
  const waits = [];
  for (let i = 0; i < 200; i++) {
    const [before, drawn] = [performance.now(), Number(canvas.dataset.frames || 0)];
    input.value = -1 + i / 100;
    input.dispatchEvent(new Event("input"));
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
        content = {"view": "benchmark", "setting": start | {name: float(value)}}
        before = time.perf_counter()
        page._heard(page, content, [])
        page._newest.wait()
        seconds.append(time.perf_counter() - before)
        assert page.told["ok"], page.status
        frames.append((dict(page.told), page.arrays))
    return np.array(seconds), frames


def drawn_in_browser(frames):
    """Seconds from a slider's event to the frame that is drawn, 200 times."""
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


def row(name, seconds):
    """A line of the table: medians, worst, frames a second by their sum."""
    median, worst = 1e3 * np.median(seconds), 1e3 * np.max(seconds)
    rate = len(seconds) / np.sum(seconds)
    print(f"| {name} | {median:.1f} | {worst:.1f} | {rate:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--browser", action="store_true")
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
    if options.browser:
        row("canvas alone, in Chromium", drawn_in_browser(recorded))


if __name__ == "__main__":
    main()
