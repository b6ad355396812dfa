from .flags import keep_compiled as keep_compiled
from .flags import use_fast_cpu as use_fast_cpu
from .programs import Program as Program
from .programs import flattened as flattened
from .programs import in_chunks as in_chunks
from .programs import padded_size as padded_size
from .progress import progress_bar as progress_bar
from .progress import waiting as waiting
