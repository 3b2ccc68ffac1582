//! The description of an export, as a data package (<https://specs.frictionlessdata.io/data-package/>).

use serde_json::{Value, json};
use store::{ColumnKind, Relation};

use crate::tables::Written;
use crate::{Format, Provenance, words};

/// `datapackage.json`: each table with its files, columns, units and words.
pub(crate) fn text(relations: &[Relation], written: &[Written], format: Format, provenance: &Provenance) -> String {
    let resource = |(n, relation): (usize, &Relation)| {
        let paths: Vec<&str> = written.iter().filter(|w| w.relation == n).map(|w| w.path.as_str()).collect();
        let field = |c: &store::Column| {
            let mut field = words::field(c);
            // A data package has words of its own for types.
            field["type"] = Value::from(kind(c.kind));
            field["partition"] = Value::from(paths.iter().any(|p| p.contains(&format!("/{}=", c.name))));
            field
        };
        json!({
            "name": relation.name, "title": relation.title, "description": relation.text, "path": paths,
            "format": format.extension(), "schema": { "fields": relation.columns.iter().map(field).collect::<Vec<_>>() },
        })
    };
    let resources: Vec<Value> = relations.iter().enumerate().filter(|(_, r)| !r.internal).map(resource).collect();
    let mut package = json!({ "profile": "data-package", "name": provenance.name() });
    for (key, value) in provenance.pairs() {
        package[key] = Value::from(value);
    }
    package["resources"] = Value::from(resources);
    format!("{package:#}\n")
}

fn kind(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Integer => "integer",
        ColumnKind::Real => "number",
        ColumnKind::Text | ColumnKind::Bytes => "string",
    }
}
