"""What is simulated: the wiggly potential, its coefficients, the strip, a whole scene.

From parts (`profiles`, `bristles`, `supports`, `loads`) to a `Scene` whose hypotheses are
checked; every solver starts from one."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
