"""Whether a shape is stable and how exact it is, and which time steps a motion takes."""
