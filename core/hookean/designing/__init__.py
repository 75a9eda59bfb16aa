"""Design: form as the unknown. Variables of a scene, goals on its equilibrium, derivatives through it."""
