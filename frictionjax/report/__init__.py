"""Reports: plain-text tables and the folder that a study leaves behind."""
