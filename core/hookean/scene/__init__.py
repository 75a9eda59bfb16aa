"""What a person describes: the scene, its text, its catalogue of forces, the report on its reading."""
