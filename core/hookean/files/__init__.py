"""Files read and written: one reader for each format."""
