"""Files into problems: problem files, maps."""
