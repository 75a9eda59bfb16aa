"""What all endpoints share: who gets in, limits, headers, schemas, logs and metrics."""
