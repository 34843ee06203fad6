use voxsoft_solid::fields::Field;

/// Name, title and unit (SI) of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldName {
    /// Name for programs.
    pub name: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// The unit; empty for plain numbers.
    pub unit: &'static str,
    /// True if its color scale is centered on zero.
    pub signed: bool,
}

/// Name, title and unit of a field.
pub fn name_of(field: Field) -> FieldName {
    let (name, title, unit, signed) = match field {
        Field::Displacement => ("displacement", "Displacement", "m", false),
        Field::X => ("dx", "Displacement along x", "m", true),
        Field::Y => ("dy", "Displacement along y", "m", true),
        Field::Z => ("dz", "Displacement along z", "m", true),
        Field::Stretch => ("stretch", "Largest principal stretch", "", false),
        Field::VonMises => ("stress", "Von Mises stress", "Pa", false),
        Field::EnergyDensity => ("energy", "Strain energy density", "J/m^3", false),
        Field::Pressure => ("pressure", "Pressure (mean stress)", "Pa", true),
        Field::Speed => ("speed", "Speed", "m/s", false),
    };
    FieldName {
        name,
        title,
        unit,
        signed,
    }
}
