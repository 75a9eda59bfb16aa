"""Archives shown, checked and drawn."""
