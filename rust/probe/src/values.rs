//! Values as JSON, in both directions.

use cobotwire_core::{Encoding, Given, Row, Unread, Value, ValueFault};
use serde_json::{Value as Json, json};

/// A value of a caller: a number, a truth value, a text, `{"bytes": "FE"}`, `{"real": "inf"}`, a
/// row, or null for a number that the encoder counts.
#[derive(Clone, Debug)]
pub struct Sample(pub Json);

type Read<T> = Result<T, Unread<()>>;
const WRONG_TYPE: Unread<()> = Unread::Fault(ValueFault::Type);

impl Given for Sample {
    type Error = ();
    type Row = Self;

    fn integer(&self, flag: bool) -> Read<i64> {
        match &self.0 {
            Json::Bool(set) if flag => Ok(i64::from(*set)),
            Json::Number(number) if number.is_f64() => Err(WRONG_TYPE),
            Json::Number(number) => number.as_i64().ok_or(Unread::Beyond),
            _ => Err(WRONG_TYPE),
        }
    }

    fn real(&self) -> Read<f64> {
        let special = self.0.get("real").and_then(Json::as_str);
        let special = special.and_then(|text| text.parse().ok());
        self.0.as_f64().or(special).ok_or(WRONG_TYPE)
    }

    fn row(&self) -> Read<Self> {
        match &self.0 {
            Json::Array(_) => Ok(self.clone()),
            _ => Err(WRONG_TYPE),
        }
    }

    fn counted(&self) -> bool {
        self.0.is_null()
    }

    fn bytes(&self) -> Read<Option<Vec<u8>>> {
        Ok(self.0.get("bytes").and_then(from_hex))
    }

    fn text(&self, encoding: Encoding) -> Read<Vec<u8>> {
        let text = self.0.as_str().ok_or(WRONG_TYPE)?;
        let encoded = match encoding {
            Encoding::Utf8 => Some(text.into()),
            Encoding::Ascii => text.is_ascii().then(|| text.into()),
            Encoding::Latin1 => text.chars().map(|c| u8::try_from(c).ok()).collect(),
        };
        encoded.ok_or(Unread::Fault(ValueFault::Text))
    }
}

impl Row for Sample {
    type Item = Self;

    fn count(&self) -> usize {
        self.0.as_array().map_or(0, Vec::len)
    }

    fn at(&self, index: usize) -> Option<Self> {
        self.0.get(index).cloned().map(Self)
    }

    fn into_value(self) -> Self {
        self
    }
}

/// Return bytes as hexadecimal digits.
pub fn hex(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Return the bytes of hexadecimal digits.
pub fn from_hex(text: &Json) -> Option<Vec<u8>> {
    let text = text.as_str()?;
    let digits = (0..text.len()).step_by(2).map(|at| text.get(at..at + 2));
    let bytes = digits.map(|digits| u8::from_str_radix(digits?, 16).ok());
    bytes.collect()
}

/// Return the values of a message, each as a caller would give it.
pub fn nested(values: &[Value]) -> Vec<Json> {
    let mut rest = values.iter().copied();
    std::iter::from_fn(|| one(&mut rest)).collect()
}

fn one(rest: &mut impl Iterator<Item = Value>) -> Option<Json> {
    Some(match rest.next()? {
        Value::Integer(raw) => json!(raw),
        Value::Real(real) if real.is_finite() => json!(real),
        Value::Real(real) => json!({"real": real.to_string()}),
        Value::Row(size) | Value::Rows(size) => (0..size).map_while(|_| one(rest)).collect(),
        Value::Bytes(size) => json!({"bytes": hex(&bytes(rest, size))}),
        Value::Text(size, encoding) => {
            let bytes = bytes(rest, size);
            let latin = || bytes.iter().map(|byte| char::from(*byte)).collect();
            match encoding {
                Encoding::Latin1 => Json::String(latin()),
                _ => String::from_utf8_lossy(&bytes).into(),
            }
        }
    })
}

fn bytes(rest: &mut impl Iterator<Item = Value>, size: usize) -> Vec<u8> {
    let byte = |value| match value {
        Value::Integer(raw) => u8::try_from(raw).ok(),
        _ => None,
    };
    rest.take(size).filter_map(byte).collect()
}
