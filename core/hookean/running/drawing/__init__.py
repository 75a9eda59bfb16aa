"""Drawing: edits of a running system that change its particles. They are added, divided, extruded or deleted by their
numbers, with what acts on them, and all others go on from where they are."""
