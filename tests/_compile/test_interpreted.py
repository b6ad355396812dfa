"""Functions of parts that are gone through step by step, uncompiled."""

from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._compile import Interpreted, scan_counts
from frictionjax._compile.numpy_rules import RULES

X = np.linspace(0.05, 0.95, 7)


def mixed(x):
    """Most steps that people write, in one function of arrays."""
    trig = jnp.sin(x) + jnp.cos(x) * jnp.tan(x) - jnp.arctan2(x, 1 + x) + jnp.arcsin(x)
    grown = jnp.exp(-x) + jnp.log1p(x) * jnp.sqrt(x) + x**3 + x**0.7 + jnp.cbrt(x)
    cut = jnp.where(x > 0.5, jnp.abs(x - 0.7), jnp.clip(x, 0.1, 0.4)) + jnp.sign(x - 0.3)
    return trig + grown + cut + jnp.round(7 * x) + jnp.floor(3 * x) + jnp.sum(x) + x.max()


def looped(x):
    """Loops, branches, sorting and a table: what has no rule is made by JAX."""
    halved = jax.lax.while_loop(lambda v: jnp.max(v) > 0.1, lambda v: 0.5 * v, x)
    summed, _ = jax.lax.scan(lambda a, v: (a + v * v, None), jnp.zeros(()), x)
    chosen = jax.lax.cond(summed > 1, lambda v: v + 1, lambda v: v - 1, jnp.sort(-x))
    return halved + chosen + jnp.searchsorted(x, 0.5) + jnp.cumsum(x)[::-1]


def carried(x):
    """Loops that carry numbers along, forwards and back, short and long."""

    def step(held, each):
        (size, pair), (one, two) = held, each
        return (size + one * two, pair[::-1] + one), (size, jnp.stack([one, size]))

    start, over = (jnp.ones(()), x[:2]), (x, jnp.sin(x))
    (size, pair), (sizes, pairs) = jax.lax.scan(step, start, over)
    back = jax.lax.scan(step, start, over, reverse=True)[1][0]
    long = jax.lax.scan(lambda a, _: (0.9 * a + x[0], a), x[0], length=100)[1]
    none = jax.lax.scan(lambda a, _: (2 * a, a), x[1], length=0)[0]
    return sizes * jnp.sum(pairs, axis=1) + back + size + pair[0] + long[-7:] + none


def looked_at(x):
    """What is asked of all at once, and what is left of a division."""
    both = jnp.stack([x, 1 - x], axis=1)
    where = jnp.argmin(both, axis=1) + 10 * jnp.argmax(jnp.sin(9 * x))
    some = jnp.any(both > 0.6, axis=1) + 2 * jnp.all(x < 0.99)
    return where + some + (9 * x - 4) % 0.7 + jax.lax.rem(9 * x - 4, 0.7 + 0 * x)


def complex_inside(x):
    """What is real at its end, through complex numbers and whole ones."""
    turn = jnp.exp(2j * jnp.pi * x)
    kernel = jnp.real(1 / (1 - 0.5 * turn)) + jnp.imag(turn**3) + jnp.abs(turn + x)
    spectrum = jnp.real(jnp.fft.ifft(jnp.fft.fft(x) * jnp.arange(x.size)))
    return kernel + spectrum + jnp.arange(x.size) // 3 + jnp.trunc(-7 * x / 2)


def chosen_of_many(x):
    """More branches than `np.choose` takes."""
    steps = [x >= k / 100 for k in range(100)]
    return jnp.piecewise(x, steps, [lambda v, k=k: v * k for k in range(101)])


def folded(x):
    """A step that holds a program, and is no call of it."""
    return jax.lax.reduce(x, jnp.ones(()), lambda a, b: 1.5 * a * b, (0,))


def each_to_its_end(x):
    """Loops whose lanes end apart, each with a number and a pair."""

    def lane(start):
        def body(at):
            return 0.5 * at[0], at[1] + jnp.stack([at[0], jnp.ones(())])

        return jax.lax.while_loop(lambda at: at[0] > 0.2, body, (start, jnp.zeros(2)))

    size, pair = jax.vmap(lane)(x)
    return size + pair[:, 0] * pair[:, 1]


@pytest.mark.parametrize(
    "fn",
    [
        mixed,
        looped,
        folded,
        complex_inside,
        chosen_of_many,
        jax.checkpoint(mixed),
        carried,
        looked_at,
        each_to_its_end,
        jax.vmap(jax.grad(lambda x: mixed(x[None])[0])),
    ],
)
def test_it_gives_what_jax_gives(fn):
    np.testing.assert_allclose(Interpreted(fn)(X), jax.jit(fn)(X), rtol=4e-15)


def test_parts_go_in_and_their_numbers_count():
    bristle = fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.1)
    slope = Interpreted(lambda b, eta: jax.grad(b.energy)(eta))
    for other in (bristle, bristle.replace(stiffness=2.0), bristle.replace(length=1.7)):
        expected = float(jax.grad(other.energy)(0.01))
        assert float(slope(other, np.asarray(0.01))) == pytest.approx(expected, rel=1e-14)


def test_what_is_no_array_belongs_to_the_program():
    padded = Interpreted(lambda x, room: jnp.pad(x, (0, room - x.size)))
    assert padded(X, 9).shape == (9,)
    assert padded(X, 12).shape == (12,)


def test_a_program_is_traced_once_for_its_shapes():
    traced = []

    def fn(x):
        traced.append(x.shape)
        return 2 * x

    doubled = Interpreted(fn)
    for x in (X, X + 1, X[:3], X):
        np.testing.assert_array_equal(doubled(x), 2 * x)
    assert traced == [(7,), (3,)]


def test_trees_come_back_as_trees():
    found = Interpreted(lambda x: {"both": (x, 2 * x), "none": None})(X)
    np.testing.assert_array_equal(found["both"][1], 2 * X)
    assert found["none"] is None


def test_every_rule_gives_the_type_that_the_program_says():
    whole = Interpreted(lambda x: (x > 0.5, jnp.floor(x).astype(int), 1 / (x - x)))(X)
    assert [v.dtype.kind for v in whole] == ["b", "i", "f"]
    assert np.all(np.isinf(whole[2]))  # quietly
    assert "add" in RULES


def test_what_a_function_holds_is_read_once():
    """Half of it was folded into the program, half read at every call."""
    held = np.array([1.0, 2.0])
    both = Interpreted(lambda x: jnp.sum(held) * jnp.sin(x) + jnp.sum(held * x[0]))
    before = both(X)
    held[:] = [2.0, 4.0]
    np.testing.assert_array_equal(both(X), before)


def test_values_that_are_not_finite_are_no_error_where_jax_looks_for_them():
    def lost(x):
        return jax.lax.fori_loop(0, 3, lambda _, v: jnp.sort(jnp.log(v)), -x)

    with jax.debug_nans(True):
        assert np.all(np.isnan(Interpreted(lost)(X)))


ROWS = np.random.default_rng(0).normal(size=(4, 5, 6))
WHICH = np.array([[0, 3, -1], [9, -9, 2]])
WHOLE = np.random.default_rng(1).integers(-5, 5, (4, 5, 6)).astype(np.int32)


def picked(x, i, k):
    """Entries and slices at places inside and outside of an array, and it in a frame."""
    kinds = [x.at[i].get(mode=mode) for mode in ("clip", "fill")]
    kinds += [n.at[i, i].get(mode="fill") for n in (x > 0, k, k.astype(np.uint8))]
    kinds += [x.at[i, i].get(mode="fill", fill_value=7.0)]
    kinds += [x.at[jnp.clip(i, 0, 3)].get(mode="promise_in_bounds")]
    axes = [x[i], x[:, i, 2], x[i, i], x[i, :, i], x[1], x[i[0, 0], :, 2:4]]
    axes += [jnp.take_along_axis(x, k % 6, axis=2), x[::-1, :, ::-1]]
    lanes = [jax.vmap(lambda row, at: row[:, at], in_axes=(1, 0))(x, k[0, :, 0])]
    lanes += [jax.vmap(jax.vmap(lambda row, at: row.at[at].get(mode="fill")))(x, k)]
    lanes += [jax.vmap(lambda at: jax.lax.dynamic_slice(x, (at, 0, at), (2, 5, 3)))(i[0])]
    framed = [jax.lax.pad(x, 0.5, ((1, 2, 0), (-1, 2, 1), (2, -3, 2)))]
    framed += [jax.lax.pad(x[:0], 0.5, ((1, 2, 3), (0, 0, 0), (0, 0, 0)))]
    edges, asked = jnp.stack([-x[0, 0, 0] / 0, 0 * x[1, 1, 1], x[0, 0, 0] / 0]), 0 * x[0, 0]
    found = [jnp.searchsorted(edges, asked, side=side) for side in ("left", "right")]
    return kinds + axes + lanes + framed + found


def test_what_only_moves_numbers_gives_the_same_bits():
    expected = jax.jit(picked)(ROWS, WHICH, WHOLE)
    for one, other in zip(Interpreted(picked)(ROWS, WHICH, WHOLE), expected, strict=True):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other, strict=True)
        np.testing.assert_array_equal(np.signbit(one), np.signbit(other))


@pytest.mark.parametrize("name", ["lt_to", "le_to"])
def test_floats_have_one_order(name):
    """-0 < 0, and no number is above or below all others, by its sign."""
    row = np.array([0.0, -0.0, np.nan, -np.nan, 1.0, -1.0, np.inf, -np.inf, 5e-324])
    pairs = [np.ravel(side) for side in np.meshgrid(row, row)]
    step = getattr(jax.lax, f"{name}_p")
    np.testing.assert_array_equal(RULES[name]({}, *pairs), step.bind(*pairs))


def test_polynomials_are_evaluated_from_the_constant_term_up():
    """One step of a program from JAX 0.12 on, where older ones write its products out."""
    terms = [1.0, -2.0, 0.5]
    found = RULES["polynomial"]({}, X, *terms)
    np.testing.assert_allclose(found, np.polyval(terms[::-1], X), rtol=1e-15)
    written = Interpreted(lambda x: jnp.polyval(jnp.array(terms[::-1]), x))(X)
    np.testing.assert_allclose(found, written, rtol=1e-15)


def test_what_a_loop_carries_is_told_without_names_of_parameters():
    """JAX 0.12 has other ones than 0.10."""

    def looped(held, start, rows):
        def step(carry, row):
            total, count = carry
            return (total + held * row[0], count + 1), (row, total)

        return jax.lax.scan(step, (start, 0), rows)

    def told(fn, *args):
        (eqn,) = [e for e in jax.make_jaxpr(fn)(*args).eqns if e.primitive.name == "scan"]
        params = {"jaxpr": eqn.params["jaxpr"]}
        return scan_counts(
            SimpleNamespace(invars=eqn.invars, outvars=eqn.outvars, params=params)
        )

    assert told(looped, X, X, np.ones((3, 2))) == (1, 2)
    assert told(jax.vmap(looped), X, X, np.ones((7, 3, 2))) == (1, 2)
