"""Energy of a rod that turns over its pinned tip: bent, and held by an angular spring."""

from typing import NamedTuple

import jax.numpy as jnp

from .._checks import Real
from .elastica import Elastica, bent_between_hinges


class TurningRod(NamedTuple):
    """A rod on an angular spring at its root, its tip held in a hinge.

    `stiffness` in N m/rad, `rest_angle` in rad, `length` in m, `bending_stiffness` in
    N m^2, `height` in m of the root above the tip.
    """

    stiffness: Real
    rest_angle: Real
    length: Real
    bending_stiffness: Real
    height: Real

    @property
    def reach(self) -> Real:
        """How far the root is ahead of the tip, or behind it, where the rod is straight."""
        return jnp.sqrt((self.length - self.height) * (self.length + self.height))

    def energy(self, ahead: Real) -> Real:
        """Stored in J with the root `ahead` (m) of the tip, from -reach to reach.

        `k/2 (theta - theta_rest)^2 + U`, theta the angle of the chord and U the energy of
        bending of the elastica between hinges. At both ends the rod is straight, and this
        is the energy of the straight one, of the rest angle and of the other sign.
        """
        turn = 0.5 * self.stiffness * (self.angle(ahead) - self.rest_angle) ** 2
        return turn + self._bent(ahead).energy

    def force(self, ahead: Real) -> Real:
        """Derivative of `energy` in N: what pulls the root back towards the tip.

        `-P sin(theta) + k (theta - theta_rest) cos(theta)^2/height`: at the ends what the
        straight rod exerts where its compression is the critical load.
        """
        chord = self.chord(ahead)
        return (
            self._twist(ahead) * self.height / chord - self.thrust(ahead) * ahead
        ) / chord

    def weight(self, ahead: Real) -> Real:
        """What the tip presses on the surface with in N: derivative of -energy by height.

        `P cos(theta) + k (theta - theta_rest) sin(theta)/chord`.
        """
        chord = self.chord(ahead)
        return (
            self._twist(ahead) * ahead / chord + self.thrust(ahead) * self.height
        ) / chord

    def thrust(self, ahead: Real) -> Real:
        """Compression P along the chord in N."""
        return self._bent(ahead).thrust

    def chord(self, ahead: Real) -> Real:
        """From the tip to the root, in m."""
        return jnp.hypot(self.height, ahead)

    def angle(self, ahead: Real) -> Real:
        """theta of the chord from the vertical in rad, > 0 with the root ahead."""
        return jnp.arctan2(ahead, self.height)

    def _twist(self, ahead: Real) -> Real:
        return self.stiffness * (self.angle(ahead) - self.rest_angle)

    def _bent(self, ahead: Real) -> Elastica:
        chord = self.chord(ahead)
        return bent_between_hinges(self.bending_stiffness, self.length, chord)
