"""What all endpoints share: authentication, limits, headers, schemas, logs and metrics."""
