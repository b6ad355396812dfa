"""Bars of a certificate end where its numbers do, and pass 1 where it is refused."""

import math

import pytest

from frictionjax.certificate.plain_curve import CurveMeasures, verdict
from frictionjax.certificate.settings import SETTINGS
from frictionjax.certificate.verdicts import Certificate, CertificateStatus

GOOD = CurveMeasures(
    distance=0.01, within=math.inf, missing_force=-0.2, viscosity=1.05, spacing=0.1
)
REST = {"residual": 0.0, "residual_error": 0.0, "scale": 1.0, "slips": 3, "skipped": 0}


def certificate(**changes):
    measured = GOOD._replace(**changes)
    return Certificate(**REST, **measured._asdict(), status=verdict(measured))


@pytest.mark.parametrize(
    ("name", "most", "status"),
    [
        ("spacing", SETTINGS.coarsest, CertificateStatus.UNRESOLVED),
        ("missing_force", SETTINGS.missing_force, CertificateStatus.SKIPPED),
        ("viscosity", 1 + SETTINGS.viscosity, CertificateStatus.VISCOSITY),
        ("distance", SETTINGS.farthest, CertificateStatus.OFF),
    ],
)
def test_a_share_above_1_is_what_is_refused(name, most, status):
    within, beyond = certificate(**{name: 0.99 * most}), certificate(**{name: 1.01 * most})
    assert within.ok
    assert max(within.shares.values()) <= 1
    assert beyond.status == status
    assert [key for key, share in beyond.shares.items() if share > 1] == [name]
    (axes,) = beyond.plot().axes
    widths = [bar.get_width() for bar in axes.patches]
    assert [width > 1 for width in widths] == [key == name for key in beyond.shares]
    assert axes.get_title(loc="left").startswith(status.name)


def test_what_is_unknown_has_no_bar():
    (axes,) = certificate(viscosity=math.nan).plot().axes
    assert "unknown" in [text.get_text() for text in axes.texts]
    (axes,) = certificate(distance=math.inf).plot().axes
    assert "inf" in [text.get_text() for text in axes.texts]
