//! Where a text says what a message is about.

use toml::de::DeTable;

/// The byte. A message begins with its section in brackets, as TOML writes it, and names the key after that; where the text
/// has not that key, it is that of the section. Without a section, a message begins with its key. `None` where the text has
/// neither.
pub(crate) fn find(text: &str, message: &str) -> Option<usize> {
    // A name in quotes may hold brackets.
    let is_header = |&end: &usize| message.starts_with('[') && DeTable::parse(&message[..end]).is_ok();
    let end = message.match_indices("] ").map(|(at, _)| at + 1).find(is_header).unwrap_or(0);
    let (section, rest) = message.split_at(end);
    let (path, document) = (DeTable::parse(section).ok()?, DeTable::parse(text).ok()?);
    let (mut path, mut table, mut place) = (path.get_ref(), document.get_ref(), None);
    while let Some((name, below)) = path.iter().next() {
        let (key, value) = table.iter().find(|(key, _)| key.get_ref() == name.get_ref())?;
        place = Some(key.span().start);
        (path, table) = (below.get_ref().as_table()?, value.get_ref().as_table()?);
    }
    let words = rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let words = words.take(if section.is_empty() { 1 } else { usize::MAX });
    let value_of =
        |word: &str| table.iter().find(|(key, _)| key.get_ref() == word).map(|(_, value)| value.span().start);
    words.filter_map(value_of).next().or(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "name = \"n\"\nschema_version = 2\nshadow.path = \"s\"\n[location]\nlatitude_deg = 147\n\
        [designs.\"HP [1] a\"]\nheating = \"HP\"\nbackup_heater_w = -1\n";

    fn found(message: &str) -> Option<&str> {
        find(TEXT, message).map(|at| TEXT[at..].lines().next().unwrap_or_default())
    }

    #[test]
    fn prop_a_message_is_placed_at_its_value_or_its_section() {
        assert_eq!(found("[location] latitude_deg = 147 is outside -90 … 90"), Some("147"));
        assert_eq!(found("[location] needs time_zone"), Some("location]"));
        assert_eq!(found("[shadow] path = \"s\": none there"), Some("\"s\""));
        assert_eq!(found("[designs.\"HP [1] a\"] backup_heater_w = -1 must lie between 0 and 1"), Some("-1"));
        assert_eq!(found("schema_version = 2, but this program reads 1"), Some("2"));
        assert_eq!(found("two designs have one name"), None);
        assert_eq!(found("[weather] has both time_zone and utc_offset"), None);
    }
}
