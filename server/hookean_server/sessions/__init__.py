"""Sessions: simulations that live on the server, one process each while they are awake."""
