//! The JSON schema of the study file, by which editors complete and check it.

use ingest::weather::WeatherFormat;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use sensitivity::Variation;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::file::StudyFile;

/// The file beside a study file to which its first line leads an editor.
pub const SCHEMA_FILE: &str = "study.schema.json";

/// The schema as text (JSON Schema 2020-12).
#[must_use]
pub fn schema() -> String {
    let mut schema = schemars::schema_for!(StudyFile);
    schema.insert("title".to_owned(), Value::from("A busclimate study"));
    format!("{:#}", schema.as_value())
}

/// A table of constants, all of which have a default.
pub(crate) fn numbers_of<T: Default + Serialize>(_: &mut SchemaGenerator) -> Schema {
    let Ok(Value::Object(defaults)) = serde_json::to_value(T::default()) else { return json_schema!({}) };
    let number = |(name, default): (String, Value)| {
        let kind = if default.is_f64() { "number" } else { "integer" };
        (name, serde_json::json!({ "type": kind, "default": default }))
    };
    let properties: Map<String, Value> = defaults.into_iter().map(number).collect();
    json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// Tables, or values, under names of one's own.
pub(crate) fn tables_of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let inner = generator.subschema_for::<T>();
    json_schema!({ "type": "object", "additionalProperties": inner })
}

/// A value for each input that can vary.
pub(crate) fn inputs_of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let inner = generator.subschema_for::<T>().to_value();
    let properties: Map<String, Value> = Variation::names().into_iter().map(|name| (name, inner.clone())).collect();
    json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// Tables of inputs with the designs that they are for.
pub(crate) fn variants(generator: &mut SchemaGenerator) -> Schema {
    let mut variant = inputs_of::<f64>(generator).to_value();
    variant["properties"]["designs"] = serde_json::json!({ "type": "array", "items": { "type": "string" } });
    json_schema!({ "type": "object", "additionalProperties": variant })
}

/// One of the formats of weather.
pub(crate) fn weather_format(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": WeatherFormat::NAMES })
}
