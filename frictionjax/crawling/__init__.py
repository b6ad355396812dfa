"""The crawler that the paper was written for: two bristles, and a spring that breathes."""

from .crawlers import crawler as crawler
