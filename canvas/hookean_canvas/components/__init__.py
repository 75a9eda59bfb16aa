"""Components built from their bundles: icons, scripts, user objects, packages."""
