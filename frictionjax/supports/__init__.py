"""Supports: the convex energy `Phi(z)` that pulls the bristle along."""

from .convex import Convex as Convex
from .spring import Spring as Spring
from .support import AbstractSupport as AbstractSupport
