"""Reports in Chromium: pictures seen, nothing asked for, WCAG 2 A and AA kept."""

import base64
import io
import time

import numpy as np
import pytest
from browser import look_at, opened_browser, skip_without_browser
from command_line import run
from PIL import Image
from sweep_like import sweep_like

from frictionjax.report.job import ReportRequest, read_job
from frictionjax.report.study_results import write_results

LOOKS = {
    "light": {},
    "dark": {"colours": "dark"},
    "phone": {"width": 360},
    "dark phone": {"width": 360, "colours": "dark"},
    "print": {"medium": "print", "width": 800},
    "print from dark": {"medium": "print", "width": 800, "colours": "dark"},
}
SMALL_COST = (
    *("--eps", "0.0971,0.0452", "--accuracies", "1e-1,1e-2", "--methods"),
    *("auto,LSODA", "--no-progress"),
)
COMMANDS = {
    "study": ("--eps", "0.097:0.031:4", "--gamma", "1,2", "--no-progress"),
    "cost": SMALL_COST,
    "design": ("--ratio", "1.5"),
    "nap": ("--bristle", "angular", "--bending-stiffness", "0.03"),
}


@pytest.fixture(scope="module")
def browser():
    skip_without_browser()
    with opened_browser() as found:
        yield found


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    request = ReportRequest("frictionjax study --report", time.perf_counter())
    data = sweep_like(failed=False).assign_attrs(method="auto")
    write_results(read_job(None)._replace(report=request), data, folder, 1.0)
    return folder / "report.html"


def require_readable(seen, dark):
    assert len(seen.images) >= 3
    assert all(seen.images)
    assert all(source.startswith("data:image/svg+xml") for source in seen.sources)
    assert all(url.startswith(("file:", "data:")) for url in seen.requests), seen.requests
    assert not seen.messages
    assert not seen.violations
    assert seen.checks > 20
    assert seen.wider == 0
    assert dark == _is_dark(seen.sources[0])


def _is_dark(source):
    """Whether a picture is the one for dark pages: of its first letters, which differ."""
    start = base64.b64decode(source.partition(",")[2][:400])
    return start.startswith(b'<svg fill="')


@pytest.mark.parametrize("look", LOOKS)
def test_a_report_is_read_in_every_light(browser, report, look):
    options = LOOKS[look]
    dark = options.get("colours") == "dark" and options.get("medium") != "print"
    require_readable(look_at(browser, report, **options), dark)


def test_what_a_page_must_not_do_is_seen(browser, tmp_path):
    """The checks themselves: a page that breaks each of them."""
    (tmp_path / "bad.html").write_text(
        "<html><body style='width: 3000px'><img src='data:image/png;base64,AAAA'>"
        "<p style='color: #aaa; background: #fff'>pale</p>"
        "<script>console.error('said')</script></body></html>"
    )
    (tmp_path / "asking.html").write_text(
        "<html lang='en'><head><title>t</title></head><body>"
        "<img alt='' src='http://127.0.0.1:9/x.png'></body></html>"
    )
    seen = look_at(browser, tmp_path / "asking.html")
    assert any(url.startswith("http:") for url in seen.requests)
    seen = look_at(browser, tmp_path / "bad.html")
    assert seen.messages
    assert seen.wider > 1000
    rules = {name for name, _ in seen.violations}
    assert {"color-contrast", "image-alt", "html-has-lang", "document-title"} <= rules
    assert seen.images == [False]


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_reports_of_all_commands_are_read_in_every_light(browser, tmp_path, command):
    result = run(command, *COMMANDS[command], "--report", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    for options in LOOKS.values():
        dark = options.get("colours") == "dark" and options.get("medium") != "print"
        require_readable(look_at(browser, tmp_path / "report.html", **options), dark)


def test_a_table_that_goes_on_has_a_shadow_at_that_side(browser, report):
    """Dark where more is hidden, the page's own white where the table ends."""
    page = browser.new_page(viewport={"width": 360, "height": 800})
    page.goto(report.absolute().as_uri())
    hidden = "e => e.scrollWidth - e.clientWidth"
    tables = page.locator(".wide:not(.picture)").all()
    wide = [one for one in tables if one.evaluate(hidden) > 40]
    assert wide
    seen = {}
    for place in ("0", "e.scrollWidth"):
        wide[-1].evaluate(f"e => {{ e.scrollLeft = {place}; }}")
        picture = Image.open(io.BytesIO(wide[-1].screenshot())).convert("L")
        rows = np.asarray(picture)[-40:]  # below the headings, which have a colour
        seen[place] = [np.median(rows[:, side]) for side in (0, -1)]
    page.close()
    left, right = seen["0"]
    assert right < 200 < left
    left, right = seen["e.scrollWidth"]
    assert left < 200 < right
