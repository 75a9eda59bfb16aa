"""Results for other programs: DXF, VTU, Abaqus, IFC, COMPAS graphs."""
