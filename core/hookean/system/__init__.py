"""A scene as particles and elements: welding, forces and energies at a state, balance, components, near misses."""
