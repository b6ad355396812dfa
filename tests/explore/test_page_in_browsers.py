"""The page in a browser: what it draws, sends and says."""

import base64
from importlib.resources import files
from itertools import groupby

import pytest
from browser import RULES, opened_browser, skip_without_browser

from frictionjax.explore.explored import explored_at
from frictionjax.explore.setting import SLIDERS, PageSetting

# A model as `anywidget` hands it to the page; the test answers in its place.
OPENED = """async ([script, style, sliders, frame]) => {
  const sheet = document.createElement("style");
  sheet.textContent = style;
  document.head.append(sheet);
  const url = URL.createObjectURL(new Blob([script], {type: "text/javascript"}));
  const page = (await import(url)).default;
  window.sent = [];
  let state;
  window.answer = frame => {
    const bytes = Uint8Array.from(atob(frame.arrays), c => c.charCodeAt(0));
    state = {sliders, told: frame.told, arrays: new DataView(bytes.buffer)};
    window.heard?.();
  };
  answer(frame);
  const model = {
    get: name => state[name],
    on: (_, fn) => { window.heard = fn; },
    off: () => {},
    send: message => sent.push(message),
  };
  page.render({model, el: document.querySelector("main")});
}"""
INK = """() => {
  const canvas = document.querySelector("canvas");
  const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let ink = 0;
  for (let i = 3; i < data.length; i += 4) ink += data[i] > 0;
  return ink;
}"""
EMPTY = "<!doctype html><html lang=en><title>Page</title><main></main></html>"


def frame(ok=True, view="", **changed):
    found = explored_at(PageSetting()._replace(**changed))
    told = {
        "view": view,
        "ok": ok,
        "status": "well" if ok else "not so",
        "setting": found.setting._asdict(),
        "wells": found.wells.size,
        "times": found.ts.size,
        "eps": found.setting.eps,
        "coefficients": found.coefficients,
    }
    return {"told": told, "arrays": base64.b64encode(found.packed()).decode()}


@pytest.fixture(scope="module")
def browser():
    skip_without_browser()
    with opened_browser() as found:
        yield found


@pytest.fixture(params=["light", "dark"])
def page(browser, request):
    context = browser.new_context(color_scheme=request.param)
    context.set_default_timeout(5000)
    page, said = context.new_page(), []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.set_content(EMPTY)
    home = files("frictionjax.explore")
    texts = [home.joinpath(name).read_text() for name in ("page.js", "page.css")]
    page.evaluate(OPENED, [*texts, [slider.sent() for slider in SLIDERS], frame()])
    page.wait_for_function("document.querySelector('canvas').dataset.frames > 0")
    yield page
    assert said == []
    context.close()


def drawn(page):
    return page.evaluate("document.querySelector('canvas').toDataURL()")


def drawn_after(page, act):
    """The picture after an act that makes the page draw."""
    page.evaluate("() => new Promise(f => setTimeout(f, 100))")  # resizing draws once too
    frames = page.evaluate("Number(document.querySelector('canvas').dataset.frames)")
    act()
    page.wait_for_function(f"document.querySelector('canvas').dataset.frames > {frames}")
    return drawn(page)


def answered(page, one):
    """The picture after an answer."""
    return drawn_after(page, lambda: page.evaluate("frame => answer(frame)", one))


def test_it_draws_and_draws_anew(page):
    assert page.evaluate(INK) > 10_000
    before = drawn(page)
    assert answered(page, frame(angle=-0.5)) != before
    label = page.get_by_role("img").get_attribute("aria-label")
    law = explored_at(PageSetting(angle=-0.5)).coefficients
    assert f"rho_plus {law['rho_plus']:.4f} N" in label
    assert f"rho_minus {law['rho_minus']:.4f} N" in label
    assert f"ratio {law['ratio']:.4f}" in label


def test_sliders_are_named_and_keys_move_them(page):
    slider = page.get_by_label("angle of the bristle")
    slider.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("sent.length > 0")
    (setting,) = page.evaluate("sent[0].settings")
    assert setting["angle"] == pytest.approx(0.51)
    others = PageSetting()._replace(angle=setting["angle"])
    assert setting == others._asdict()  # eps too, though its slider has steps
    assert slider.get_attribute("aria-valuetext") == "0.51 rad"


# In place of Python: answers after `pace` ms each what the newest message asks, rho_plus
# being the angle, so that the picture's label says whose it is.
ANSWERING = """([frame, pace]) => {
  let waiting = [];
  window.labels = [];
  const canvas = document.querySelector("canvas");
  const seen = () => labels.push(canvas.getAttribute("aria-label"));
  new MutationObserver(seen).observe(canvas, {attributeFilter: ["aria-label"]});
  sent.push = message => {
    Array.prototype.push.call(sent, message);
    waiting = message.settings.map(setting => [message.view, setting]);
  };
  setInterval(() => {
    if (!waiting.length) return;
    const [view, setting] = waiting.shift();
    const coefficients = {...frame.told.coefficients, rho_plus: setting.angle};
    answer({...frame, told: {...frame.told, view, setting, coefficients}});
  }, pace);
}"""
# A slider to and fro in 200 places, what has been sent two seconds after that, and for how
# many ms it was moved.
DRAGGED = """async () => {
  const input = document.querySelector("input");
  const places = [];
  const begun = performance.now();
  for (let i = 0; i < 200; i++) {
    input.value = 0.6 + 0.4 * Math.sin(i / 7);
    places.push(Number(input.value));
    input.dispatchEvent(new Event("input"));
    await new Promise(done => setTimeout(done, 8));
  }
  const moved = performance.now() - begun;
  await new Promise(done => setTimeout(done, 2000));
  return [places, sent.map(one => one.settings.map(setting => setting.angle)), moved];
}"""


# A place that is sent at once, another one, and before its time has come Python's.
MOVED_BY_BOTH = """async frame => {
  const input = document.querySelector("input");
  const moved = angle => {
    input.value = angle;
    input.dispatchEvent(new Event("input"));
  };
  moved(0.7);
  while (!sent.length) await new Promise(done => setTimeout(done, 1));
  moved(0.8);
  answer(frame);
  await new Promise(done => setTimeout(done, 500));
}"""


def in_order(some, places):
    rest = iter(places)
    return all(one in rest for one in some)


@pytest.mark.parametrize("pace", [1, 40, 150])
def test_the_last_place_of_a_slider_is_shown_however_slow_python_is(page, pace):
    page.evaluate(ANSWERING, [frame(), pace])
    places, messages, moved = page.evaluate(DRAGGED)
    sent = [angle for message in messages for angle in message]
    assert messages[0] == places[:1]  # at once
    assert in_order(sent, places)
    assert 2 <= len(messages) <= 3 + moved / 50  # the least pause between two, in ms
    labels = page.evaluate("labels")
    shown = [float(label.split("rho_plus ")[1].split(" N")[0]) for label in labels]
    assert in_order([one for one, _ in groupby(shown)], places)
    assert sent[-1] == shown[-1] == places[-1]
    assert len(set(shown)) > (5 if pace > 100 else 15)


def test_places_are_asked_for_again_where_no_answer_comes(page):
    places, messages, _ = page.evaluate(DRAGGED)
    assert len(messages) > 3
    assert messages[-1][-1] == places[-1]


def test_where_python_moves_a_slider_to_places_before_are_not_asked_for(page):
    page.evaluate(MOVED_BY_BOTH, frame(view="", angle=-0.3))
    assert page.get_by_label("angle of the bristle").input_value() == "-0.3"
    assert page.evaluate("sent.map(one => one.settings[0].angle)") == [0.7]


def test_the_tip_goes_along_without_python(page):
    before = drawn(page)
    page.get_by_label("time, moves the tip along").focus()
    assert drawn_after(page, lambda: page.keyboard.press("End")) != before
    assert page.evaluate("sent") == []


def test_what_is_refused_is_said_and_greyed_and_goes_again(page):
    before = drawn(page)
    assert answered(page, frame(ok=False, angle=-0.5)) == before
    assert page.get_by_role("status").inner_text() == "not so"
    assert page.locator("canvas.stale").count() == 1
    assert answered(page, frame(angle=-0.5)) != before
    assert page.locator("canvas.stale").count() == 0


def test_answers_move_the_sliders_of_other_views_only(page):
    page.get_by_label("angle of the bristle").focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("sent.length > 0")
    view = page.evaluate("sent[0].view")
    slider = page.get_by_label("angle of the bristle")
    answered(page, frame(view=view, angle=-0.3))
    assert slider.input_value() == "0.51"
    answered(page, frame(view="another", angle=-0.3))
    assert slider.input_value() == "-0.3"


def test_everybody_can_use_it(page):
    page.evaluate(files("axe_playwright_python").joinpath("axe.min.js").read_text())
    found = page.evaluate("rules => axe.run({runOnly: rules})", RULES)
    assert [one["id"] for one in found["violations"]] == []
    assert len(found["passes"]) > 5
