"""The fitted inertia ratio is that of the body as built, with a sharp or rounded rim, or a ball."""

from dataclasses import replace

import numpy as np
import pytest

import spincyl as sc

SIZE = sc.Scale(radius=0.012, mass=0.05)


def general(rng):
    """A body of random moments, with a stem or cap that lands at a random inclination."""
    i3 = rng.uniform(0.2, 0.9)
    more = {"fillet": rng.uniform(0.0, 1.0), "theta_end": rng.uniform(1.0, 3.1)}
    return sc.Body(rng.uniform(0.0, 3.0), i3 * rng.uniform(0.55, 8.0), i3, **more)


def ball(rng):
    """A ball with its centre of mass above or, like a tippe top, below its middle."""
    i3 = rng.uniform(0.2, 0.8)
    return sc.Body.ball(rng.choice([-1, 1]) * rng.uniform(0.1, 0.8), i3 * rng.uniform(0.6, 2.0), i3)


def rounded(rng):
    tall, bore = rng.uniform(0.1, 4.0), rng.uniform(0.0, 0.9)
    return sc.Body.tube(tall, bore, fillet=rng.uniform(0.0, min(1.0 - bore, tall)))


KINDS = {
    "tube": lambda rng: sc.Body.tube(rng.uniform(0.1, 6.0), rng.uniform(0.0, 0.95)),
    "rounded tube": rounded,
    "capsule": lambda rng: sc.Body.solid(rng.uniform(1.1, 3.0), fillet=1.0),
    "balls": lambda rng: sc.Body.balls(rng.uniform(1.0, 3.0)),
    "ball": ball,
    "general": general,
}


def steady(rng, kind, points=10, off=0):
    """A body of a kind, random inclinations at which it is steady, and its rates there."""
    while True:
        body = replace(KINDS[kind](rng), scale=SIZE)
        theta = np.linspace(0.0, np.pi, 600)[1 + off : -1 - off]
        rate = body.rate(theta)
        known = np.flatnonzero(np.isfinite(rate) & (rate > 1e-2) & (rate < 1e2))
        known = known[off : known.size - off]
        if known.size > 3 * points:
            chosen = rng.choice(known, points, replace=False)
            return body, theta[chosen], rate[chosen]


@pytest.mark.parametrize("kind", KINDS)
def test_exact_points_of_any_body_give_its_ratio_as_built_within_the_error(kind):
    rng = np.random.default_rng(3)
    for _ in range(3):
        body, theta, rate = steady(rng, kind)
        found = sc.data.compare(body, theta, rate)
        assert abs(found.ratio - body.i1 / body.i3) <= found.ratio_err < 1e-6 * found.ratio
        assert np.abs(found.residual / found.rate).max() < 1e-9
        for name in ("ell", "i3", "fillet", "theta_end"):
            assert np.array_equal(getattr(found.fitted, name), getattr(body, name), equal_nan=True)
        assert found.fitted.scale == SIZE


def test_the_error_of_the_ratio_is_that_of_many_rounded_bodies():
    rng, pulls = np.random.default_rng(4), []
    for _ in range(25):
        body, theta, rate = steady(rng, rng.choice([*KINDS][1:]), off=6)
        errors = {"theta_err": 1e-3, "rate_err": 1e-3 * rate}
        found = sc.data.compare(body, rng.normal(theta, 1e-3), rng.normal(rate, 1e-3 * rate), **errors)
        pulls.append((found.ratio - found.expected) / found.ratio_err)
    assert 0.7 < np.std(pulls) < 1.3 and abs(np.mean(pulls)) < 0.5


def test_a_fitted_body_keeps_what_was_measured_and_the_plot_shows_balls_beyond_90_degrees():
    plt = pytest.importorskip("matplotlib.pyplot")
    top = sc.Body.ball(-0.3, 0.45, 0.5)
    theta = np.radians([60.0, 80.0, 95.0, 110.0, 120.0])
    found = sc.data.compare(top, theta, 1.001 * top.rate(theta), common=np.inf)
    assert found.factor == pytest.approx(1.001, rel=1e-9) and found.fitted.fillet == 1
    ax = found.plot()
    assert ax.get_ylim() == (0, 180) and r"\rho = 1" in ax.get_title()
    shown = {line.get_label()[:9]: line for line in ax.get_lines()}
    built = shown["$I_1/I_3 "]
    rates = np.interp(np.degrees(theta), built.get_ydata(), built.get_xdata())
    assert rates == pytest.approx(top.rate(theta), rel=1e-5)
    plt.close(ax.figure)


def test_an_inclination_beyond_the_end_of_a_body_is_refused_with_its_end():
    for body, said in (
        (sc.Body.solid(2.5), r"\(0, pi/2\]"),
        (replace(sc.Body.ball(0.1, 0.4, 0.4), theta_end=2.0), r"\(0, 2\]"),
    ):
        theta = np.array([0.9, 1.0, 1.1, 1.2, 2.5])
        with pytest.raises(ValueError, match=f"theta: expected inclinations in {said}, in radians"):
            sc.data.compare(body, theta, np.ones(5))
    with pytest.raises(ValueError, match=r"theta: expected inclinations in \(0, pi/2\].*np.radians"):
        sc.data.fit_losses([0, 1, 2, 3, 4, 5], np.arange(40, 34, -1.0), body=sc.Body.balls())
