"""Jobs: long relaxations and sweeps, done in the background and kept in the store."""
