"""Results drawn: pictures, sheets of pictures, legends and charts."""
