//! Answers with the texts of errors.

use cobotwire_core::{Choice, Direction, Row, decode, encode};
use cobotwire_table::{Edition, Quote, Shown};
use serde_json::{Value as Json, json};

use crate::values::{Sample, from_hex};

impl Quote for Sample {
    fn quote(&self) -> Shown {
        match &self.0 {
            Json::Null => Shown::Other("Ellipsis".into()),
            Json::Bool(set) => Shown::Flag(*set),
            Json::Number(number) => Shown::Integer(number.as_i64().unwrap_or_default()),
            Json::String(text) => Shown::Text(text.clone()),
            Json::Array(all) => {
                Shown::List(all.iter().map(|each| Self(each.clone()).quote()).collect())
            }
            Json::Object(special) => match (special.get("real"), special.get("bytes")) {
                (Some(Json::String(real)), _) => Shown::Real(real.parse().unwrap_or_default()),
                (_, bytes) => Shown::Bytes(bytes.and_then(from_hex).unwrap_or_default()),
            },
        }
    }
}

/// The edition of the last `{"read": PATH}`.
#[derive(Default)]
pub struct Texts(Option<Edition>);

impl Texts {
    /// Answer one line with the text of its error, or with null.
    pub fn answer(&mut self, line: &str) -> String {
        let question: &Json = &serde_json::from_str(line).unwrap_or_default();
        let direction = match question["direction"].as_str() {
            Some("request") => Direction::Request,
            _ => Direction::Reply,
        };
        let text = match (&self.0, question["read"].as_str()) {
            (_, Some(path)) => match Edition::read(&std::fs::read(path).unwrap_or_default()) {
                Ok(edition) => {
                    self.0 = Some(edition);
                    None
                }
                Err(bad) => Some(bad.to_string()),
            },
            (Some(edition), None) => text(edition, direction, question),
            (None, None) => Some("there is no edition".into()),
        };
        json!(text).to_string()
    }
}

fn text(edition: &Edition, direction: Direction, question: &Json) -> Option<String> {
    let table = &edition.protocol.table;
    if let Some(data) = from_hex(&question["bytes"]) {
        let error = decode(table, direction, &data, None).err()?;
        return Some(edition.decode_error(direction, error, &data));
    }
    let mut commands = edition.commands.iter();
    let index = commands.position(|command| question["command"] == *command.name)?;
    let command = table.commands().get(index)?;
    let values = Sample(question["values"].clone());
    let found = encode::<Sample>(
        table.frame(),
        command,
        direction,
        &values,
        Choice::default(),
    );
    let error = found.err()?;
    Some(edition.encode_error((index, direction), &error, values.count(), None))
}
