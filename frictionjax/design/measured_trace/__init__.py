"""Measured friction traces: force or position against time, from files and arrays."""

from .samples import Trace as Trace
from .samples import simulate_trace as simulate_trace
