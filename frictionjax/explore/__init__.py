"""One page to explore a bristle on a surface: sliders, drawn anew while they move."""

from .page import explore as explore
