"""How the service starts, is found, and ends."""
