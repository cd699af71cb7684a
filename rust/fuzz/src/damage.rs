//! Damages the file of an edition, and uses what is read from it.

use cobotwire_core::{Direction, Event, Framer, Listening, decode};
use cobotwire_table::Edition;
use serde_json::{Value, json};

/// Return the file of a document in which random values are replaced by values of the same or of
/// another type. `roll` returns a number below the given one.
pub fn changed(document: &Value, roll: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let others = [
        json!(null),
        json!(true),
        json!(-1),
        json!(0),
        json!(1),
        json!(2),
        json!(8),
        json!(255),
        json!(16384),
        json!(i64::MIN),
        json!(i64::MAX),
        json!(u64::MAX),
        json!(1e300),
        json!(0.5),
        json!("1/0"),
        json!("9223372036854775807/3"),
        json!(""),
        json!("text"),
        json!("bits"),
        json!("joint"),
        json!([]),
        json!([[]]),
        json!([0, 1]),
        json!({}),
        json!("float"),
    ];
    let mut changed = document.clone();
    for _ in 0..=roll(3) {
        *place(&mut changed, roll) = others[roll(others.len())].clone();
    }
    changed.to_string().into_bytes()
}

/// Return a random value inside a document.
fn place<'a>(at: &'a mut Value, roll: &mut impl FnMut(usize) -> usize) -> &'a mut Value {
    let size = match at {
        Value::Array(items) => items.len(),
        Value::Object(members) => members.len(),
        _ => 0,
    };
    if size == 0 || roll(9) == 0 {
        return at;
    }
    let index = roll(size);
    match at {
        Value::Array(items) => place(&mut items[index], roll),
        Value::Object(members) => place(members.values_mut().nth(index).unwrap(), roll),
        other => other,
    }
}

/// Read a file; if it is a table, cut and decode bytes with it.
pub fn used(json: &[u8]) {
    let edition = match Edition::read(json) {
        Err(error) => return assert!(error.to_string().contains(' '), "{error}"),
        Ok(edition) => edition,
    };
    let table = &edition.protocol.table;
    let sizes =
        (0..=255).flat_map(|id| [2, 3, 5].map(|size| [0xFE, 0xFE, size, id, 0xFA, 0xFA, 0xFA]));
    let mut framer = Framer::new(table.rules(Listening::Both).clone());
    let mut frames = Vec::new();
    framer.feed(&sizes.flatten().collect::<Vec<u8>>(), |event| {
        if let Event::Frame { frame, .. } = event {
            frames.push(frame.bytes().to_vec());
        }
    });
    for frame in frames {
        let _ = decode(table, Direction::Request, &frame, None);
        let _ = decode(table, Direction::Reply, &frame, None);
    }
}
