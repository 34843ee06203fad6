"""Results: state, fields, contact, vibrations and compliance at an equilibrium."""
