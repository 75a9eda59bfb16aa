"""Values that scenes are made of: columns and fields, meshes, units, colours."""
