"""Scenes relaxed and moved through time: runs, their results, patches, scripts and streams."""
