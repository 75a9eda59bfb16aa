"""Design: form as the unknown. Variables of a scene, goals and constraints on its equilibrium, derivatives through it."""
