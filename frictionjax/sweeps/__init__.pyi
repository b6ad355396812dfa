from .noiseless import without_noise as without_noise
from .provenance import origin as origin
from .provenance import set_meanings as set_meanings
from .selected_cells import one_scene as one_scene
from .selected_cells import whole_grid as whole_grid
from .sweep_cells import sweep as sweep
