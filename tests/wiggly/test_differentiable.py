"""Derivatives of `solve` outside of compiled functions, as notebooks take them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

NAMES = ["slope", "stiffness", "angle", "support", "amplitude", "period", "z0"]
NAMES += ["eps", "gamma"]
POINT = np.array([0.1, 1.0, 0.5, 1.0, 1.2, 3.0, 0.01, 0.05, 1.0])


def curve(p, accuracy=1e-3, ts=(0.0, 1.2, 2.9), **options):
    bristle = fx.bristles.SlantedSpring(p[1], 2.4, 1.0, p[2])
    parts = fx.profiles.Sine(p[0]), bristle, fx.supports.Spring(p[3])
    scene = fx.Scene(*parts, fx.loads.Sine(p[4], p[5]), 3.0, p[6])
    return fx.solve(scene, p[7], p[8], ts, accuracy, **options)


def end(p):
    """Of both, so that the program is that of both."""
    found = curve(p)
    return found.z[-1] + 0.3 * found.dissipation[-1]


@pytest.fixture(scope="module")
def slopes():
    """Of the last place and of what is lost until then, by every number: (2, 9)."""

    def values(p):
        found = curve(p, 1e-6)
        return jnp.stack([found.z[-1], found.dissipation[-1]])

    back = jax.vjp(values, jnp.asarray(POINT))[1]
    return np.stack([back(one)[0] for one in jnp.eye(2)])


@pytest.mark.parametrize("i", range(POINT.size), ids=NAMES)
def test_every_number_has_its_derivative(slopes, i):
    """Against differences of lanes, which take other steps."""
    width = 3e-5 * max(0.1, POINT[i])
    shift = width * np.eye(POINT.size)[i]
    ends = [curve(POINT + by * shift, 1e-8) for by in (1, -1, 2, -2)]
    z, lost = ([float(getattr(e, n)[-1]) for e in ends] for n in ("z", "dissipation"))
    for found, (ahead, behind, two, too) in zip(slopes, (z, lost), strict=True):
        # Of order 4: of order 2 their own error is 1e-4.
        difference = (8 * (ahead - behind) - (two - too)) / (12 * width)
        assert abs(found[i] - difference) < 2e-6 * np.max(np.abs(found))


def test_plain_numbers_have_the_derivatives_of_arrays():
    """What `jax.grad(f)(0.1)` hands on is no array inside: it was taken for a constant."""
    width, plain = 1e-5, POINT.tolist()
    ends = [float(end([0.1 + share * width, *plain[1:]])) for share in (1, -1)]
    slopes = jax.grad(end)(plain)
    assert float(slopes[0]) == pytest.approx((ends[0] - ends[1]) / (2 * width), rel=1e-2)
    assert slopes == jax.grad(end)([jnp.asarray(number) for number in plain])


def test_other_numbers_of_times_are_asked_of_the_same_programs(slopes):
    """There is room for more, where the last time is asked for again and again."""
    programs = {"_planned", "_forth", "_back"}
    compiled = []

    def listen(event, seconds, **told):
        if event.endswith("backend_compile_duration"):
            compiled.append(told.get("fun_name", "").removeprefix("jit(").removesuffix(")"))

    def values(p):
        found = curve(p, 1e-6, ts=[0.0, 0.4, 1.2, 2.1, 2.9])
        assert found.ts.shape == found.z.shape == found.dissipation.shape == (5,)
        return jnp.stack([found.z[-1], found.dissipation[-1]])

    jax.monitoring.register_event_duration_secs_listener(listen)
    try:
        back = jax.vjp(values, jnp.asarray(POINT))[1]
        np.testing.assert_allclose(back(jnp.eye(2)[0])[0], slopes[0], rtol=1e-3)
    finally:
        jax.monitoring.unregister_event_duration_listener(listen)
    assert programs.isdisjoint(compiled)


@pytest.mark.slow  # two programs of their own: 14 s
def test_places_alone_have_the_derivatives_that_they_have_beside_energies():
    """Of z alone, what goes with the steps is not gone through again."""

    def places(slope):
        return curve([slope, *POINT[1:]], dissipation=False).z

    def all_of_it(slope):
        found = curve([slope, *POINT[1:]])
        return found.z, found.dissipation, found.residual

    by = jnp.array([0.3, -1.0, 0.7])
    alone = jax.vjp(places, 0.1)[1](by)[0]
    beside = jax.vjp(all_of_it, 0.1)[1]((by, 0 * by, 0 * by))[0]
    assert alone != 0
    assert float(alone) == pytest.approx(float(beside), rel=1e-9)


def with_eps(eps, **options):
    return curve([*POINT[:7], eps, 1.0], **options).z[-1]


@pytest.mark.parametrize(
    "derived",
    [
        lambda: jax.jvp(with_eps, (0.05,), (1.0,)),
        lambda: jax.jvp(jax.jit(with_eps), (0.05,), (1.0,)),
        lambda: jax.jit(jax.jacfwd(with_eps))(0.05),
        lambda: jax.jit(jax.jacfwd(jax.jit(with_eps)))(0.05),
        lambda: jax.vmap(jax.jacfwd(with_eps))(jnp.array([0.05, 0.06])),
        lambda: jax.hessian(with_eps)(0.05),
        lambda: jax.eval_shape(jax.grad(jax.grad(with_eps)), 0.05),
    ],
    ids=[
        "jvp",
        "jvp of jit",
        "jit of jacfwd",
        "both",
        "vmap of jacfwd",
        "hessian",
        "grad of grad",
    ],
)
def test_derivatives_that_there_are_not_say_what_does(derived):
    with pytest.raises(ValueError, match=r"adjoint = None: needs diffrax.ForwardMode\(\)"):
        derived()


def test_reverse_mode_goes_through_batches():
    total = jax.grad(lambda eps: jnp.sum(jax.vmap(with_eps)(eps)))
    assert jax.eval_shape(total, jnp.array([0.05, 0.06])).shape == (2,)
