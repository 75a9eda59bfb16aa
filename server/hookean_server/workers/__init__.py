"""Processes that compute: the pool that drives them, and the tasks that they do."""
