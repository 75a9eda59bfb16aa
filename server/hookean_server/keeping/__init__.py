"""What the store's file is made of, and how it is checked, salvaged and copied."""
