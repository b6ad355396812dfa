"""Tips with mass: `m_eps z'' + eps^gamma z' = l - Phi' - V_eps'`, every slip integrated.

Solutions of a second-order equation are not ordered: lanes from below and above prove
nothing, so each cell is integrated from z0 on, at three tolerances that have to agree.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
