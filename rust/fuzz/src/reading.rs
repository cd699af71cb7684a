//! The oracle for values: what a whole legal frame says, form by form, number by number.

use cobotwire_core::{
    BadRaw, Decoded, Direction, Field, Form, Layout, Listening, Number, Order, Table, Value,
};

/// A number of a frame: the index of its field, what stands there, and what that stands for.
pub type Read = (usize, i64, Value);

/// What decoding a whole legal frame of that direction must give. `of`: only forms of the command
/// with that index; `None`: it has none.
pub fn read(
    table: &Table,
    direction: Direction,
    frame: &[u8],
    of: Option<usize>,
) -> Option<Result<Decoded, BadRaw>> {
    Some(numbers(table, direction, frame, of)?.map(|found| decoded(table, found, frame)))
}

/// What reading a frame must give that was heard in one direction or in both: a request's forms go
/// before a reply's.
pub fn heard(
    table: &Table,
    listening: Listening,
    frame: &[u8],
) -> Option<Result<(Form, Vec<Read>), BadRaw>> {
    let ways: &[Direction] = match &listening {
        Listening::To(way) => std::slice::from_ref(way),
        Listening::Both => &[Direction::Request, Direction::Reply],
    };
    let read = || {
        ways.iter()
            .filter_map(|way| numbers(table, *way, frame, None))
    };
    read().find(Result::is_ok).or_else(|| read().next())
}

/// A form and its numbers as the core tells them.
pub fn decoded(table: &Table, (form, read): (Form, Vec<Read>), frame: &[u8]) -> Decoded {
    Decoded {
        form,
        values: values(table, form, &read),
        address: (!table.frame().addresses.is_empty()).then(|| frame[2]),
    }
}

/// The same as a form and its numbers.
pub fn numbers(
    table: &Table,
    direction: Direction,
    frame: &[u8],
    of: Option<usize>,
) -> Option<Result<(Form, Vec<Read>), BadRaw>> {
    let format = table.frame();
    let start = format.overhead() + 1;
    let data = &frame[start..frame.len() - format.check.size()];
    let mut first = None;
    for (command, record) in table.commands().iter().enumerate() {
        if record.id != frame[start - 1] || of.is_some_and(|of| of != command) {
            continue;
        }
        for (layout, fields) in record.layouts(direction).iter().enumerate() {
            if fields.size() != data.len() {
                continue;
            }
            let form = Form {
                direction,
                command,
                layout,
            };
            match of_form(form, fields, data, start) {
                Ok(read) => return Some(Ok((form, read))),
                Err(bad) => first = first.or(Some(Err(bad))),
            }
        }
    }
    first
}

/// The numbers as values: a row is told before its elements.
fn values(table: &Table, form: Form, read: &[Read]) -> Vec<Value> {
    let fields = table.commands()[form.command].layouts(form.direction)[form.layout].fields();
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

fn of_form(form: Form, layout: &Layout, data: &[u8], offset: usize) -> Result<Vec<Read>, BadRaw> {
    let mut read = Vec::new();
    let mut at = 0;
    let bad = |field, case, element, whole, at| BadRaw {
        form,
        field,
        case,
        element,
        whole,
        offset: offset + at,
    };
    for (index, field) in layout.fields().iter().enumerate() {
        let case = case(layout, field, data)
            .map_err(|(selector, whole, at)| bad(selector, 0, 0, whole, at))?;
        for (element, number) in field.cases[case].numbers.iter().enumerate() {
            let whole = whole(number, &data[at..]);
            let allowed = if field.choices.is_empty() {
                number.minimum <= whole && whole <= number.maximum
            } else {
                field.choices.contains(&whole)
            };
            if !allowed {
                return Err(bad(index, case, element, whole, at));
            }
            read.push((index, whole, physical(number, whole)));
            at += number.width;
        }
    }
    Ok(read)
}

/// The index of a field's case; or the selector, what it holds, and where it stands.
fn case(layout: &Layout, field: &Field, data: &[u8]) -> Result<usize, (usize, i64, usize)> {
    let Some(selector) = field.selector else {
        return Ok(0);
    };
    let at = size(&layout.fields()[..selector]);
    let whole = whole(&layout.fields()[selector].cases[0].numbers[0], &data[at..]);
    let mut cases = field.cases.iter();
    cases
        .position(|case| case.when.contains(&whole))
        .ok_or((selector, whole, at))
}

fn size(fields: &[Field]) -> usize {
    let numbers = fields.iter().flat_map(|field| &field.cases[0].numbers);
    numbers.map(|number| number.width).sum()
}

/// By the definition: the unsigned word, and less by its span above `signed_at`.
fn whole(number: &Number, data: &[u8]) -> i64 {
    let mut bytes = data[..number.width].to_vec();
    if number.order == Order::Little {
        bytes.reverse();
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

fn physical(number: &Number, whole: i64) -> Value {
    if number.multiply == 1 && number.divide == 1 {
        Value::Whole(whole)
    } else {
        let exact = i128::from(whole) * i128::from(number.multiply);
        Value::Real(exact as f64 / number.divide as f64)
    }
}
