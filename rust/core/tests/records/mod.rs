//! Reads the generator's JSON: the records of Python's `cobotwire.protocol.table` by attribute.

use cobotwire_core::{
    Algorithm, Case, Check, Command, Direction, Field, FrameFormat, Layout, Number, NumberEncoding,
    Order, Shape, Table, Variant,
};
use serde_json::Value;

use crate::common::{self, Sample};

/// A table, the names of its commands, and its vectors.
pub struct Edition {
    pub table: Table,
    pub names: Vec<String>,
    pub vectors: Vec<Vector>,
}

/// One frame and its values, or the reason of its rejection.
pub struct Vector {
    pub name: String,
    pub command: String,
    pub direction: Direction,
    pub frame: Option<Vec<u8>>,
    pub values: Vec<Sample>,
    pub printed: Option<Vec<u8>>,
    pub rejected: Option<(String, usize)>,
    pub text: bool,
}

impl Edition {
    /// Read an edition of the spec. The generator makes these files, and git ignores them.
    pub fn generated(name: &str) -> Self {
        let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{path}: {error}; run `make products` first"));
        Self::read(&text)
    }

    pub fn read(text: &str) -> Self {
        let json: Value = serde_json::from_str(text).expect("the file is JSON");
        let commands = &json["table"]["commands"];
        Self {
            names: all(commands, |command| string(&command["name"])),
            table: Table::new(frame(&json["table"]["frame"]), all(commands, command))
                .expect("the generator writes tables that can be interpreted"),
            vectors: all(&json["vectors"], vector),
        }
    }
}

fn vector(json: &Value) -> Vector {
    let rejected = &json["rejected"];
    Vector {
        name: string(&json["name"]),
        command: json["command"].as_str().unwrap_or_default().to_owned(),
        direction: match string(&json["direction"]).as_str() {
            "request" => Direction::Request,
            "reply" => Direction::Reply,
            other => panic!("{other} is not a direction"),
        },
        frame: json["frame"].as_str().map(bytes),
        values: json["values"]
            .as_array()
            .map_or(vec![], |values| values.iter().map(sample).collect()),
        printed: json["printed"].as_str().map(bytes),
        rejected: (!rejected.is_null()).then(|| {
            (
                string(&rejected["reason"]),
                usize::try_from(integer(&rejected["offset"])).unwrap(),
            )
        }),
        text: json["text"].as_bool().unwrap_or_default(),
    }
}

fn sample(json: &Value) -> Sample {
    match json {
        Value::Bool(set) => Sample::Bool(*set),
        Value::Array(_) => Sample::Row(all(json, sample)),
        Value::Number(number) => number
            .as_i64()
            .map_or_else(|| Sample::Real(number.as_f64().unwrap()), Sample::Integer),
        // In the tables of these tests, a field of one byte is a number.
        Value::String(text) => match units(text).as_slice() {
            [one] => one.clone(),
            units => Sample::Row(units.to_vec()),
        },
        _ => Sample::Text,
    }
}

/// Return the bytes of a field of bytes (hex digits) or of a text, as the codec takes them.
fn units(text: &str) -> Vec<Sample> {
    let hex = |pair: &str| pair.len() == 2 && pair.bytes().all(|digit| digit.is_ascii_hexdigit());
    let found = if text.split(' ').all(hex) {
        bytes(text)
    } else {
        text.as_bytes().to_vec()
    };
    let integers = found.into_iter().map(i64::from);
    integers.map(Sample::Integer).collect()
}

fn frame(json: &Value) -> FrameFormat {
    let bytes = |json: &Value| -> Vec<u8> {
        let integers = all(json, integer).into_iter();
        integers
            .map(|value| u8::try_from(value).expect("a byte"))
            .collect()
    };
    let header = bytes(&json["header"]);
    let addresses = &json["addresses"];
    let addresses = if addresses.is_null() {
        vec![]
    } else {
        bytes(addresses)
    };
    // Files from before other checks existed do not name the footer check.
    let check = match json["check"].as_str().unwrap_or("footer") {
        "footer" => Check::Footer(bytes(&json["footer"])[0]),
        "crc16-modbus" => common::crc16_modbus(),
        "sum" => common::computed(Algorithm::Sum, 1, header.len() + 1 + addresses.len().min(1)),
        other => panic!("{other} is not a check"),
    };
    FrameFormat {
        layout: Layout::usual(header.len(), !addresses.is_empty()),
        header,
        addresses,
        check,
        maximum_length: integer(&json["maximum_length"]),
    }
}

fn command(json: &Value) -> Command {
    Command {
        id: u16::try_from(integer(&json["id"])).expect("an id"),
        request: all(&json["request"], variant),
        reply: all(&json["reply"], variant),
    }
}

fn variant(json: &Value) -> Variant {
    Variant::new(all(&json["fields"], field))
}

fn field(json: &Value) -> Field {
    Field {
        flag: json["kind"] == "flag",
        many: json["many"] == true,
        choices: all(&json["choices"], integer),
        selector: usize::try_from(integer(&json["selector"])).ok(),
        cases: all(&json["cases"], case),
        shape: Shape::Numbers,
        each: 0,
        varies: false,
    }
}

fn case(json: &Value) -> Case {
    Case {
        when: all(&json["when"], integer),
        numbers: all(&json["numbers"], number),
    }
}

fn number(json: &Value) -> Number {
    Number {
        width: usize::try_from(integer(&json["width"])).expect("a width"),
        order: if json["order"] == "little" {
            Order::Little
        } else {
            Order::Big
        },
        signed_at: integer(&json["signed_at"]),
        multiply: integer(&json["multiply"]),
        divide: integer(&json["divide"]),
        minimum: integer(&json["minimum"]),
        maximum: integer(&json["maximum"]),
        encoding: match json["encoding"].as_str() {
            Some(word) => NumberEncoding::named(word).expect("an encoding"),
            None => NumberEncoding::Integer,
        },
        ..Number::default()
    }
}

fn all<T>(json: &Value, read: impl Fn(&Value) -> T) -> Vec<T> {
    json.as_array()
        .unwrap_or_else(|| panic!("{json} is not an array"))
        .iter()
        .map(read)
        .collect()
}

fn integer(json: &Value) -> i64 {
    json.as_i64()
        .unwrap_or_else(|| panic!("{json} is not an integer"))
}

fn string(json: &Value) -> String {
    json.as_str()
        .unwrap_or_else(|| panic!("{json} is not a string"))
        .to_owned()
}

fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("hex"))
        .collect()
}
