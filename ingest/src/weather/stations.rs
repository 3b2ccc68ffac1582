//! Which station's parts of the files count.

use std::collections::{BTreeMap, BTreeSet};

use super::table::Table;
use crate::FileRecord;

/// Keeps the parts of one station: the wanted one, or the only one that has temperature and irradiance. Records of files that
/// have parts of other stations only go with them.
pub(super) fn choose(
    parts: &mut Vec<(Table, usize)>,
    records: &mut Vec<FileRecord>,
    wanted: Option<&str>,
) -> Result<(), String> {
    let Some(station) = station(parts, wanted)? else { return Ok(()) };
    let all: BTreeSet<usize> = parts.iter().map(|(_, record)| *record).collect();
    parts.retain(|(table, _)| table.station.as_ref() == Some(&station));
    let kept: BTreeSet<usize> = parts.iter().map(|(_, record)| *record).collect();
    let mut place = 0..;
    records.retain(|_| place.next().is_some_and(|p| kept.contains(&p) || !all.contains(&p)));
    for (_, record) in parts {
        *record -= all.difference(&kept).filter(|other| *other < record).count();
    }
    Ok(())
}

/// The station that counts; `None` where the files name none.
fn station(parts: &[(Table, usize)], wanted: Option<&str>) -> Result<Option<String>, String> {
    // Which of them have temperature and irradiance, all their files together.
    let mut stations: BTreeMap<&String, (bool, bool)> = BTreeMap::new();
    for (table, _) in parts {
        let Some(name) = &table.station else { continue };
        let (temperature, light) = stations.entry(name).or_default();
        *temperature |= table.has.temperature;
        *light |= table.has.global || (table.has.diffuse && table.has.direct);
    }
    let named: Vec<&String> = stations.keys().copied().collect();
    if let Some(wanted) = wanted {
        let wanted = wanted.to_lowercase();
        if named.contains(&&wanted) {
            return Ok(Some(wanted));
        }
        return if parts.is_empty() {
            Ok(None)
        } else {
            Err(format!("no files of the station {wanted:?}; there are {named:?}"))
        };
    }
    let complete: Vec<&String> =
        stations.iter().filter(|(_, has)| **has == (true, true)).map(|(name, _)| *name).collect();
    match (named.as_slice(), complete.as_slice()) {
        ([], _) => Ok(None),
        ([one], _) | (_, [one]) => Ok(Some((*one).clone())),
        (_, []) => Err(format!("none of the stations {named:?} has both temperature and irradiance")),
        (_, several) => Err(format!("files of the stations {several:?} lie together; choose one: `station = \"…\"`")),
    }
}
