"""What the commands of the command line do, imported when one runs."""
