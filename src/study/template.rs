//! Study files to start from.

use cabin::Vehicle;

/// The parts of a study file that differ between a new study and the demo's.
pub struct Template<'a> {
    pub name: &'a str,
    pub note: Option<&'a str>,
    pub buses: &'a [u32],
}

/// A commented study file with every default.
pub fn render(template: &Template) -> String {
    let note = match template.note {
        Some(note) => format!("note = {}\n", quoted(note)),
        None => "# note = \"shown at the top of the report\"\n".to_owned(),
    };
    let vehicle = toml::to_string(&Vehicle::default()).expect("a flat struct of numbers becomes TOML");
    let vehicle: String = vehicle.lines().map(|line| format!("# {line}\n")).collect();
    include_str!("template.toml")
        .replace("@NAME@", &quoted(template.name))
        .replace("@NOTE@", &note)
        .replace("@BUSES@", &format!("{:?}", template.buses))
        .replace("@VEHICLE@", &vehicle)
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cli_the_template_is_a_study_with_the_defaults() {
        let text = render(&Template { name: "a \"name\"", note: Some("a note"), buses: &[183] });
        let file: super::super::file::StudyFile = toml::from_str(&text).unwrap();
        assert_eq!((file.name.as_str(), file.note.as_deref()), ("a \"name\"", Some("a note")));
        assert_eq!(file.missions.buses, [183]);
        // The commented constants are the defaults, written as they would be typed.
        let typed = text.replace("# cabin_length_m", "cabin_length_m").replace("# roof_area_m2", "roof_area_m2");
        let file: super::super::file::StudyFile = toml::from_str(&typed).unwrap();
        assert_eq!(file.vehicle, Vehicle::default());
        assert_eq!(file.designs.len(), 5);
    }
}
