//! The oracle for values: decodes a whole legal frame variant by variant and number by number.

use cobotwire_core::{
    BadRaw, Decoded, Direction, Field, Listening, Number, Order, Table, Value, Variant, VariantId,
};

use crate::oracle::number;

/// A number of a frame: the index of its field, its raw value and its physical value.
pub type Read = (usize, i64, Value);

/// Return the result that decoding a whole legal frame of one direction must have; `None` if it has
/// no variant. `of` restricts the search to variants of the command with that index.
pub fn read(
    table: &Table,
    direction: Direction,
    frame: &[u8],
    of: Option<usize>,
) -> Option<Result<Decoded, BadRaw>> {
    Some(numbers(table, direction, frame, of)?.map(|found| decoded(table, found, frame)))
}

/// Return the result of reading a received frame. If it may have either direction, variants of
/// requests come before those of replies.
pub fn received(
    table: &Table,
    listening: Listening,
    frame: &[u8],
) -> Option<Result<(VariantId, Vec<Read>), BadRaw>> {
    let directions: &[Direction] = match &listening {
        Listening::To(direction) => std::slice::from_ref(direction),
        Listening::Both => &[Direction::Request, Direction::Reply],
    };
    let read = || {
        directions
            .iter()
            .filter_map(|direction| numbers(table, *direction, frame, None))
    };
    read().find(Result::is_ok).or_else(|| read().next())
}

/// Return a variant and its numbers in the form of the core's result.
pub fn decoded(table: &Table, (variant, read): (VariantId, Vec<Read>), frame: &[u8]) -> Decoded {
    Decoded {
        variant,
        values: values(table, variant, &read),
        address: table.frame().layout.address_at.map(|at| frame[at]),
    }
}

/// Decode a whole legal frame of one direction; return the variant and its numbers, or the first
/// number that no variant allows. `None`: the frame has no variant.
pub fn numbers(
    table: &Table,
    direction: Direction,
    frame: &[u8],
    of: Option<usize>,
) -> Option<Result<(VariantId, Vec<Read>), BadRaw>> {
    let format = table.frame();
    let has_id = format.has_id(direction);
    let start = if has_id {
        format.layout.data_at
    } else {
        format.layout.id.at
    };
    let end = frame.len() - format.check.size();
    // A frame of the other direction may be too short for data.
    let data = frame.get(start..end)?;
    let id = number(format.layout.id, frame);
    let mut first = None;
    for (command, record) in table.commands().iter().enumerate() {
        if has_id && id != Some(record.id) || of.is_some_and(|of| of != command) {
            continue;
        }
        for (variant, fields) in record.variants(direction).iter().enumerate() {
            if fields.size() != data.len() {
                continue;
            }
            let variant = VariantId {
                direction,
                command,
                variant,
            };
            match of_variant(variant, fields, data, start) {
                Ok(read) => return Some(Ok((variant, read))),
                Err(bad) => first = first.or(Some(Err(bad))),
            }
        }
    }
    first
}

/// Return the numbers as values: a row precedes its elements.
fn values(table: &Table, variant: VariantId, read: &[Read]) -> Vec<Value> {
    let fields =
        table.commands()[variant.command].variants(variant.direction)[variant.variant].fields();
    let mut values = Vec::new();
    for (index, field) in fields.iter().enumerate() {
        let own = || read.iter().filter(|(of, ..)| *of == index);
        if field.many {
            values.push(Value::Row(own().count()));
        }
        values.extend(own().map(|(_, _, value)| *value));
    }
    values
}

fn of_variant(
    id: VariantId,
    variant: &Variant,
    data: &[u8],
    offset: usize,
) -> Result<Vec<Read>, BadRaw> {
    let mut read = Vec::new();
    let mut at = 0;
    let bad = |field, case, element, raw, at| BadRaw {
        variant: id,
        field,
        case,
        element,
        raw,
        offset: offset + at,
    };
    for (index, field) in variant.fields().iter().enumerate() {
        let case = case(variant, field, data)
            .map_err(|(selector, raw, at)| bad(selector, 0, 0, raw, at))?;
        for (element, number) in field.cases[case].numbers.iter().enumerate() {
            let raw = raw_value(number, &data[at..]);
            let allowed = if !field.choices.is_empty() {
                field.choices.contains(&raw)
            } else if !number.choices.is_empty() {
                number.choices.contains(&raw)
            } else {
                number.minimum <= raw && raw <= number.maximum
            };
            if !allowed {
                return Err(bad(index, case, element, raw, at));
            }
            read.push((index, raw, physical(number, raw)));
            at += number.width;
        }
    }
    Ok(read)
}

/// Return the index of a field's case; or the selector's index, raw value and position as an error.
fn case(variant: &Variant, field: &Field, data: &[u8]) -> Result<usize, (usize, i64, usize)> {
    let Some(selector) = field.selector else {
        return Ok(0);
    };
    let at = size(&variant.fields()[..selector]);
    let raw = raw_value(&variant.fields()[selector].cases[0].numbers[0], &data[at..]);
    let mut cases = field.cases.iter();
    cases
        .position(|case| case.when.contains(&raw))
        .ok_or((selector, raw, at))
}

fn size(fields: &[Field]) -> usize {
    let numbers = fields.iter().flat_map(|field| &field.cases[0].numbers);
    numbers.map(|number| number.width).sum()
}

/// Return the raw value by its definition: the unsigned number, minus `256^width` above
/// `signed_at`; for a float its index in the ordered list of floats, with 0.0 at 0.
fn raw_value(number: &Number, data: &[u8]) -> i64 {
    let mut bytes = data[..number.width].to_vec();
    if number.order == Order::Little {
        bytes.reverse();
    }
    if number.is_float() {
        let negative = bytes[0] >= 0x80;
        bytes[0] &= 0x7F;
        let rank = bytes
            .iter()
            .fold(0, |word, byte| word << 8 | i64::from(*byte));
        return if negative { -1 - rank } else { rank };
    }
    let word = bytes
        .iter()
        .fold(0, |word, byte| word * 256 + i64::from(*byte));
    if word > number.signed_at {
        word - 256_i64.pow(number.width as u32)
    } else {
        word
    }
}

fn physical(number: &Number, raw: i64) -> Value {
    if number.is_float() {
        let rank = (if raw < 0 { -1 - raw } else { raw }) as u64;
        let sign = u64::from(raw < 0) << (8 * number.width - 1);
        Value::Real(if number.width == 4 {
            f64::from(f32::from_bits((rank | sign) as u32))
        } else {
            f64::from_bits(rank | sign)
        })
    } else if number.multiply == 1 && number.divide == 1 {
        Value::Integer(raw)
    } else {
        let exact = i128::from(raw) * i128::from(number.multiply);
        Value::Real(exact as f64 / number.divide as f64)
    }
}
