"""Base of step size controllers that wrap another one."""

import diffrax
from equinox import AbstractVar


class AbstractWrappedController(diffrax.AbstractAdaptiveStepSizeController):
    """Forwards what a solver asks of a controller to the one inside."""

    controller: AbstractVar[diffrax.AbstractAdaptiveStepSizeController]

    @property
    def rtol(self):
        return self.controller.rtol

    @property
    def atol(self):
        return self.controller.atol

    @property
    def norm(self):
        return self.controller.norm
