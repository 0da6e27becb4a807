"""Plan files, tables and pictures."""
