"""What follows from an equilibrium: frequencies, buckling, paths under load, mechanisms, load cases, and what
its surface is like."""
