"""Tests run in 64 bits, like everything that uses the library."""

import jax
import pytest

jax.config.update("jax_enable_x64", True)

_WORTH_SHARING = 0.5  # s of compilation


@pytest.fixture(scope="session", autouse=True)
def shared_programs(tmp_path_factory, worker_id):
    """Both workers of a run compile the large programs once; nothing outlives the run."""
    base = tmp_path_factory.getbasetemp()
    folder = base if worker_id == "master" else base.parent
    jax.config.update("jax_compilation_cache_dir", str(folder / "xla"))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", _WORTH_SHARING)
