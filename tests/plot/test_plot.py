"""Pictures hold the data they claim to, and touch no global setting."""

import io

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from sweep_like import EPS, sweep_like

import frictionjax as fx
from frictionjax.convergence.order import Verdict
from frictionjax.plot.style import follows_slips

LAW = fx.friction(fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0))
SPRING = fx.supports.Spring(2.0)


def drawn(figure):
    """The axes of a figure after rendering it (warnings are errors)."""
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    for axes in figure.axes:
        assert axes.get_xlabel()
        assert axes.get_ylabel()
        texts = axes.get_xlabel() + axes.get_ylabel()
        assert texts.count("(") >= 2, "units are missing"
    return figure.axes


def data(line):
    return [np.asarray(values, dtype=float) for values in line.get_data()]


def labels(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def labelled(axes, start):
    return next(line for line in axes.lines if line.get_label().startswith(start))


def convergence(**kwargs):
    found = sweep_like(**kwargs)
    return found, fx.study(found).orders, fx.study(found).plot()


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_convergence_shows_points_fits_and_failures():
    found, orders, figure = convergence()
    state, energy, strip = drawn(figure)
    assert strip.get_ylabel().startswith("sup$_t$ dist")
    assert state.get_xscale() == state.get_yscale() == "log"
    assert energy.get_ylabel().endswith("(J)")
    points = [line for line in state.lines if line.get_linestyle() == "None"]
    shown = np.sort(np.concatenate([data(p)[1] for p in points if p.get_marker() != "x"]))
    known = found.sup_error.values[np.isfinite(found.sup_error.values)]
    assert shown == pytest.approx(np.sort(known))
    cross = next(p for p in points if p.get_marker() == "x")
    assert data(cross)[0] == pytest.approx(EPS[-1:])
    fit = labelled(state, "$\\gamma$ = 0.5: order 0.50")
    line = orders.sel(gamma=0.5)
    assert data(fit)[0] == pytest.approx([float(line.eps_min), float(line.eps_max)])
    assert data(fit)[1] == pytest.approx(data(fit)[0] ** 0.5)
    assert "failed, $\\gamma$ = 1" in labels(state)
    guides = [line for line in state.lines if line.get_linestyle() == ":"]
    slopes = [np.diff(np.log(data(g)[1])) / np.diff(np.log(data(g)[0])) for g in guides]
    assert np.ravel(slopes) == pytest.approx([0.5, 1.0])


def test_every_kind_of_line_that_is_drawn_is_named_and_no_other():
    found = sweep_like(failed=False)
    strip = found.drop_vars(["sup_error", "dissipation_error"])
    study = fx.study(found)
    for data, curves in ((found, None), (strip, study.curves)):
        figure = fx.plot.draw_convergence(data, study.orders, curves)
        (key,) = figure.legends
        lines = {
            t.get_text(): h.get_linestyle()
            for t, h in zip(key.get_texts(), key.legend_handles, strict=True)
        }
        assert lines["fit: its order and 95% interval above"] == "-"
        axes = drawn(figure)
        used = {line.get_linestyle() for one in axes for line in one.lines}
        assert set(lines.values()) == used | {"None"}
        bottom = min(one.get_legend().get_window_extent().y0 for one in axes)
        assert 0 <= key.get_window_extent().y0 < key.get_window_extent().y1 <= bottom


def test_names_of_slopes_that_end_together_do_not_touch():
    found = sweep_like(failed=False)
    found["sup_error"] = found.sup_error * [[0.3], [1.0]]
    state = drawn(fx.plot.draw_convergence(found, fx.study(found).orders))[0]
    low, high = sorted((t.get_window_extent() for t in state.texts), key=lambda b: b.y0)
    assert low.y1 <= high.y0


def test_lemmas_are_not_shown_for_noise_of_which_they_are_not():
    found = sweep_like(failed=False)
    orders = fx.study(found).orders.assign(noise_order=("gamma", [0.5, 0.5]))
    figure = fx.plot.draw_convergence(found, orders)
    for axes in drawn(figure):
        assert not axes.texts
        assert all(line.get_linestyle() != ":" for line in axes.lines)
    (key,) = figure.legends
    assert not any("lemmas" in text.get_text() for text in key.get_texts())


def test_an_error_of_nothing_is_a_triangle_on_the_axis():
    found = sweep_like(failed=False)
    found["strip_excess"] = found.strip_excess.where(found.eps > 0.02, 0.0)
    axes = drawn(fx.plot.draw_convergence(found, fx.study(found).orders))
    for index, gamma in enumerate(found.gamma.values):
        none = labelled(axes[-1], f"0, below the axis, $\\gamma$ = {gamma:.3g}")
        assert data(none)[0] == pytest.approx(EPS[EPS <= 0.02])
        assert data(none)[1] == pytest.approx(np.full(2, 0.025 * index))
    assert not any("below the axis" in one for one in labels(axes[0]))


def test_points_outside_the_window_are_hollow():
    found = sweep_like(failed=False)
    orders = fx.study(found).orders
    orders["eps_max"] = ("gamma", [0.05, 0.2])
    axes = drawn(fx.plot.draw_convergence(found, orders))[0]
    hollow = [p for p in axes.lines if p.get_markerfacecolor() == "white"]
    assert data(hollow[0])[0] == pytest.approx(EPS[EPS > 0.05])
    assert data(hollow[1])[0].size == 0


def test_legends_say_what_the_points_show_where_it_is_another_order():
    found = sweep_like(failed=False)
    orders = fx.study(found).orders
    orders["order_seen"] = ("gamma", [0.52, 1.45])
    orders["verdict"] = ("gamma", np.array([0, Verdict.NOT_YET_SEEN], dtype=np.int8))
    same, other = labels(drawn(fx.plot.draw_convergence(found, orders))[0])
    assert "at these" not in same
    assert "order 1.45 at these $\\epsilon$" in other
    assert "for $\\epsilon \\to 0$: 1.00, 95% [1.00, 1.00], not yet seen" in other


def test_minor_ticks_where_decades_are_few():
    found = sweep_like(failed=False)
    few = drawn(fx.plot.draw_convergence(found, fx.study(found).orders))[0]
    assert few.xaxis.get_minorticklocs().size > 0
    wide = found.assign_coords(eps=np.geomspace(0.1, 1e-6, 6))
    many = drawn(fx.plot.draw_convergence(wide, fx.study(wide).orders))[0]
    assert many.xaxis.get_minorticklocs().size == 0
    assert many.xaxis.get_majorticklocs().size > 4


def test_convergence_without_dissipation_or_orders():
    found = sweep_like(dissipation=False).isel(eps=[0, 1])
    axes = drawn(fx.plot.draw_convergence(found, fx.study(found).orders))
    assert len(axes) == 2  # distances from the limit and from the strip
    assert "$\\gamma$ = 1: too few points for an order" in labels(axes[0])


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_convergence_where_everything_failed():
    found = sweep_like()
    found["status"] = found.status.copy(data=np.full((2, 6), 1, dtype=np.int8))
    found["sup_error"] = found.sup_error * np.nan
    crosses = [
        line
        for line in drawn(fx.plot.draw_convergence(found, fx.study(found).orders))[0].lines
        if line.get_marker() == "x"
    ]
    assert [data(c)[0].size for c in crosses] == [6, 6]


def test_trajectories():
    found = sweep_like()
    axes = drawn(fx.plot.draw_trajectories(found, gamma=0.5, eps=[EPS[3], EPS[0]]))
    main = axes[0]
    assert len(main.lines) == 3
    assert data(main.lines[0])[1] == pytest.approx(
        found.z.sel(gamma=0.5, eps=EPS[0]).values
    )
    assert data(labelled(main, "limit"))[1] == pytest.approx(found.z_limit.values)
    strip = main.collections[0].get_paths()[0].vertices[:, 1]
    assert strip.min() == pytest.approx(float(found.z_minus.min()))
    assert strip.max() == pytest.approx(float(found.z_plus.max()))


def test_failed_cells_are_not_chosen():
    axes = drawn(fx.plot.draw_trajectories(sweep_like(), gamma=1.0))[0]
    assert "$\\epsilon$ = 0.0158 m" in labels(axes)
    assert "$\\epsilon$ = 0.01 m" not in labels(axes)


def test_the_eps_in_between_can_be_told_from_the_limit():
    found = sweep_like(failed=False)
    fine = found.assign_coords(eps=np.geomspace(0.1, 1e-6, 6))
    shown = labels(drawn(fx.plot.draw_trajectories(fine, gamma=1.0))[0])
    assert [one for one in shown if "epsilon" in one] == [
        f"$\\epsilon$ = {eps} m" for eps in ("0.1", "0.01", "1e-06")
    ]


def test_slips_are_shown_where_the_times_resolve_them():
    coarse = fx.plot.draw_trajectories(sweep_like(), gamma=0.5)
    assert len(drawn(coarse)) == 1
    fine = sweep_like().interp(time=np.linspace(0, 3, 2001))
    fine["status"] = fine.status.astype(np.int8)
    main, zoom = drawn(fx.plot.draw_trajectories(fine, gamma=0.5))
    low, high = zoom.get_xlim()
    assert 0 < high - low < 1.5
    frame = main.patches[0]
    assert frame.get_x() == pytest.approx(low)
    assert frame.get_height() == pytest.approx(np.ptp(zoom.get_ylim()))


def test_the_close_up_joins_no_states_between_which_slips_are_left_out():
    fine = sweep_like(failed=False).interp(time=np.linspace(0, 3, 601))
    fine["status"] = fine.status.astype(np.int8)
    fine = fine.assign_coords(eps=np.geomspace(0.1, 1e-4, 6))
    main, zoom = drawn(fx.plot.draw_trajectories(fine, gamma=1.0))
    assert {line.get_marker() for line in main.lines} == {"None"}
    looks = [(one.get_linestyle(), one.get_marker()) for one in zoom.lines]
    assert looks == [("-", "None"), ("None", "."), ("None", "."), ("--", "None")]
    assert zoom.get_title(loc="left").endswith("dots: too few times to follow slips")
    seen = fx.plot.draw_trajectories(fine, gamma=1.0, eps=0.1)
    assert drawn(seen)[1].get_title(loc="left").endswith("in the frame on the left")


def test_rounding_where_two_wells_meet_is_no_slip():
    """A tip at rest there is in one well or the other by the last digit of its state."""
    rest = np.where(np.arange(200) % 2, 0.8 + 1e-16, 0.8 - 2e-16)
    assert follows_slips(rest, 0.1)
    crossed = np.where(np.arange(200) % 2, 0.8 + 1e-6, 0.8 - 1e-6)
    assert not follows_slips(crossed, 0.1)


def test_unknown_gamma_or_eps_is_an_error():
    with pytest.raises(ValueError, match=r"gamma = 3: needs one of 0\.5, 1"):
        fx.plot.draw_trajectories(sweep_like(), gamma=3.0)
    with pytest.raises(ValueError, match=r"eps = 3: needs one of 0\.1, "):
        fx.plot.draw_dissipation(sweep_like(), eps=3.0)


def test_loop_is_force_against_displacement():
    found = sweep_like()
    axes = drawn(fx.plot.draw_loop(found, SPRING, LAW, gamma=0.5, eps=EPS[0]))[0]
    z, force = data(labelled(axes, "$\\epsilon$ = 0.1 m"))
    assert z == pytest.approx(found.z.sel(gamma=0.5, eps=EPS[0]).values)
    assert force == pytest.approx(found["load"].values - 2.0 * z)
    levels = [data(line)[1][0] for line in axes.lines[-2:]]
    assert levels == pytest.approx([float(LAW.rho_plus), float(LAW.rho_minus)])


def test_an_eps_whose_slips_the_times_do_not_follow_is_no_line_of_a_false_sawtooth():
    """Of 601 times on a way of 0.9 m some 15 a well, 1 and far fewer."""
    found = sweep_like(failed=False).interp(time=np.linspace(0, 3, 601))
    found["status"] = found.status.astype(np.int8)
    found = found.assign_coords(eps=np.geomspace(0.1, 1e-4, 6))
    eps = found.eps.values[[0, 2, 5]]
    axes = drawn(fx.plot.draw_loop(found, SPRING, LAW, gamma=1.0, eps=eps))[0]
    looks = [(one.get_linestyle(), one.get_marker()) for one in axes.lines[:4]]
    assert looks == [("-", "None"), ("None", "."), ("None", "."), ("--", "None")]
    assert axes.get_title(loc="left").endswith("dots: too few times to follow slips")
    fine = fx.plot.draw_loop(found, SPRING, LAW, gamma=1.0, eps=eps[0])
    assert "dots" not in drawn(fine)[0].get_title(loc="left")


def test_levels_of_the_loop_are_named_where_no_curve_runs():
    axes = drawn(fx.plot.draw_loop(sweep_like(), SPRING, LAW, gamma=0.5))[0]
    inside = axes.get_window_extent()
    assert all(name.get_window_extent().x0 > inside.x1 for name in axes.texts)
    legend = axes.get_legend().get_window_extent()
    assert legend.y1 < inside.y0
    assert 0 < legend.x0 < legend.x1 < axes.figure.bbox.x1


def test_dissipation():
    found = sweep_like()
    axes = drawn(fx.plot.draw_dissipation(found, gamma=0.5))[0]
    assert len(axes.lines) == 4
    assert data(labelled(axes, "limit"))[1] == pytest.approx(found.dissipation_limit.values)
    with pytest.raises(ValueError, match="dataset = 'no dissipation'"):
        fx.plot.draw_dissipation(sweep_like(dissipation=False))


def test_mu_of_the_paper():
    """Lemma 3: mu = omega/(1 + a omega), a = -tan(theta) and cot(theta_lim)."""
    cases = [
        (fx.plot.draw_mu_slanted, lambda t: -np.tan(t), 0.0),
        (fx.plot.draw_mu_angular, lambda t: 1 / np.tan(t), np.arctan(0.1)),
    ]
    for draw, lean, start in cases:
        axes = drawn(draw())[0]
        for name, omega in (("+", 0.1), ("-", -0.1)):
            angle, mu = data(labelled(axes, f"$\\mu_{name}$"))
            assert mu == pytest.approx(omega / (1 + lean(angle) * omega))
            assert start < angle[0] < start + 1e-3
            assert np.arctan(10) - 1e-3 < angle[-1] < np.arctan(10)


def test_nap_of_the_paper():
    axes = drawn(fx.plot.draw_nap())[0]
    for name, rest in (("with", 0.3), ("against", -0.3)):
        angle, rho = data(labelled(axes, name))
        mu = 0.1 / (1 + 0.1 / np.tan(angle))
        assert rho == pytest.approx((angle - rest) / np.tan(angle) * mu)
    name = labelled(axes, "with").get_label().split(",")[1].strip()
    assert axes.texts[0].get_text() == f"only above {name}"  # as the legend calls it


def test_nap_of_a_rod_of_ones_own():
    """Every curve is what `nap` says of the rod at that angle; the dots that of the rod."""
    surface, rod = fx.profiles.Fourier([0.004, 0.0], [0.05, 0.01]), [2.0, 0.5]
    own = fx.bristles.AngularSpring(rod[0], rod[1] / np.cos(0.8), rod[1], 0.2)
    left, right = drawn(fx.plot.draw_own_nap(surface, own, 0.1))
    angle = data(labelled(left, "with the nap"))[0][137]
    stands = fx.bristles.AngularSpring(rod[0], rod[1] / np.cos(angle), rod[1], 0.2)
    found = fx.nap(surface, stands, 0.1)
    for name, rho, axial in (
        ("with the nap", found.rho_with, found.axial_with),
        ("against it", found.rho_against, found.axial_against),
        ("turned over, against it", found.rho_flipped, found.axial_flipped),
    ):
        assert data(labelled(left, name))[1][137] == pytest.approx(rho, rel=1e-9)
        assert data(labelled(right, name))[1][137] == pytest.approx(-axial, rel=1e-9)
    critical = data(labelled(right, "critical load $\\pi^2 B/L^2$"))[1][137]
    assert critical == pytest.approx(found.critical_load, rel=1e-12)
    dots = [line.get_data() for line in left.lines if line.get_marker() == "o"]
    assert [float(x[0]) for x, _ in dots] == pytest.approx([0.8] * 3)
    assert float(dots[0][1][0]) == pytest.approx(fx.nap(surface, own).rho_with)
    with pytest.raises(ValueError, match="needs an AngularSpring"):
        fx.plot.draw_own_nap(surface, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))


def test_global_settings_and_pyplot_stay_untouched():
    """Whatever the user has set neither leaks in nor is lost."""
    with mpl.rc_context({"font.size": 23.0, "axes.grid": False}):
        before = dict(mpl.rcParams)
        figure = fx.plot.draw_dissipation(sweep_like())
        axes = drawn(figure)[0]
        assert dict(mpl.rcParams) == before
    assert axes.xaxis.label.get_fontsize() < 12
    assert {text.get_fontsize() for text in axes.get_xticklabels()} == {10.0}
    assert axes.xaxis.get_gridlines()[0].get_visible()
    assert figure._repr_png_().startswith(b"\x89PNG")


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_a_picture_of_several_axes_goes_into_a_part_of_a_figure():
    study = fx.study(sweep_like())
    mine = Figure(figsize=(24, 6), layout="constrained")
    left, right = mine.subfigures(1, 2, width_ratios=[1, 3])
    assert study.plot(figure=right) is right
    assert len(right.axes) == 3
    assert not left.axes
    assert mine.get_size_inches().tolist() == [24, 6]
    mine.savefig(io.BytesIO(), format="png", dpi=40)
    with pytest.raises(ValueError, match=r"figure = .*needs a matplotlib Figure or SubFig"):
        study.plot(figure=right.axes[0])
    with pytest.raises(ValueError, match=r"ax = .*needs None, as .*several axes: figure "):
        study.plot(ax=right.axes[0])
