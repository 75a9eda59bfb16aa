"""What the workshop needs of a form: cutting patterns and lengths of cables."""
