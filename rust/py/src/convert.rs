//! Converts a Python `Table`, attribute by attribute, to the core's.

use cobotwire_core::{
    Algorithm, Bits, Case, Check, Command, Computed, Crc, CrcParameters, Encoding, Field,
    FrameFormat, Layout, Number, NumberEncoding, Order, Part, Shape, Table, Variant,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

#[derive(FromPyObject)]
struct NumberRecord {
    width: usize,
    order: String,
    signed_at: i64,
    multiply: i64,
    divide: i64,
    minimum: i64,
    maximum: i64,
    #[pyo3(from_py_with = number_encoding)]
    encoding: NumberEncoding,
    kind: String,
    choices: Vec<i64>,
    shift: u32,
    bits: u32,
    more: bool,
}

#[derive(FromPyObject)]
struct CaseRecord {
    when: Vec<i64>,
    numbers: Vec<NumberRecord>,
}

#[derive(FromPyObject)]
struct FieldRecord {
    kind: String,
    many: bool,
    choices: Vec<i64>,
    selector: i64,
    cases: Vec<CaseRecord>,
    each: usize,
    encoding: String,
    padding: i64,
    sizes: Option<(i64, i64)>,
}

#[derive(FromPyObject)]
struct VariantRecord {
    fields: Vec<FieldRecord>,
}

#[derive(FromPyObject)]
struct CommandRecord {
    id: u16,
    name: String,
    request: Vec<VariantRecord>,
    reply: Vec<VariantRecord>,
}

#[derive(FromPyObject)]
struct FrameRecord {
    header: Vec<u8>,
    footer: Vec<u8>,
    maximum_length: i64,
    check: Option<CheckRecord>,
    check_from: usize,
    addresses: Vec<u8>,
    address_at: Option<usize>,
    length_at: usize,
    length_number: UnsignedRecord,
    id_at: usize,
    id_number: UnsignedRecord,
    data_at: usize,
    overhead: usize,
    reply_has_id: bool,
}

#[derive(FromPyObject)]
struct UnsignedRecord {
    width: usize,
    order: String,
}

#[derive(FromPyObject)]
struct CheckRecord {
    algorithm: String,
    width: usize,
    order: String,
    crc: Option<CrcRecord>,
}

#[derive(FromPyObject)]
struct CrcRecord {
    width: u32,
    poly: u128,
    init: u128,
    refin: bool,
    refout: bool,
    xorout: u128,
}

#[derive(FromPyObject)]
struct TableRecord {
    frame: FrameRecord,
    commands: Vec<CommandRecord>,
}

/// Return the core's table, and the names of its commands.
pub fn table(given: &Bound<'_, PyAny>) -> PyResult<(Table, Vec<String>)> {
    let TableRecord { frame, commands } = given.extract()?;
    let names: Vec<String> = commands.iter().map(|record| record.name.clone()).collect();
    let commands = commands.into_iter().map(command).collect();
    let table = Table::new(frame_format(frame)?, commands).map_err(|error| {
        let name = names.get(error.command).map_or("", String::as_str);
        PyValueError::new_err(format!("table: {name}: {}", error.misfit))
    })?;
    Ok((table, names))
}

/// Return the core's frame format.
pub fn format(given: &Bound<'_, PyAny>) -> PyResult<FrameFormat> {
    frame_format(given.extract()?)
}

fn frame_format(record: FrameRecord) -> PyResult<FrameFormat> {
    let layout = Layout {
        address_at: record.address_at,
        length: part(record.length_at, &record.length_number)?,
        id: part(record.id_at, &record.id_number)?,
        data_at: record.data_at,
        overhead: record.overhead,
        reply_has_id: record.reply_has_id,
    };
    let check = match (record.check, record.footer.as_slice()) {
        (None, &[footer]) => Check::Footer(footer),
        (check, _) => Check::Computed(Box::new(Computed {
            width: check.as_ref().map_or(0, |check| check.width),
            order: order(check.as_ref().map_or("big", |check| &check.order)),
            algorithm: check.map(algorithm).transpose()?,
            from: record.check_from,
            footer: record.footer,
        })),
    };
    Ok(FrameFormat {
        header: record.header,
        addresses: record.addresses,
        check,
        maximum_length: record.maximum_length,
        layout,
    })
}

fn part(at: usize, number: &UnsignedRecord) -> PyResult<Part> {
    match number.width {
        1 | 2 => Ok(Part {
            at,
            wide: number.width == 2,
            order: order(&number.order),
        }),
        _ => Err(rejected("LEN and the id must have one or two bytes")),
    }
}

fn algorithm(record: CheckRecord) -> PyResult<Algorithm> {
    if let Some(CrcRecord {
        width,
        poly,
        init,
        refin,
        refout,
        xorout,
    }) = record.crc
    {
        let crc = Crc::new(CrcParameters {
            width,
            poly,
            init,
            refin,
            refout,
            xorout,
        });
        let crc = crc.filter(|crc| crc.size() == record.width);
        return crc.map(Algorithm::Crc).ok_or_else(|| {
            rejected("a CRC must have 1 to 120 bits, and the check must be as wide as the CRC")
        });
    }
    Ok(match record.algorithm.as_str() {
        "sum" => Algorithm::Sum,
        "inverted-sum" => Algorithm::InvertedSum,
        "negated-sum" => Algorithm::NegatedSum,
        "xor" => Algorithm::Xor,
        "fletcher" => Algorithm::Fletcher(256),
        "fletcher-16" => Algorithm::Fletcher(255),
        _ => return Err(rejected("the algorithm of the check is unknown")),
    })
}

fn rejected(what: &str) -> PyErr {
    PyValueError::new_err(format!("table: {what}"))
}

fn number_encoding(word: &Bound<'_, PyAny>) -> PyResult<NumberEncoding> {
    let found = NumberEncoding::named(word.extract::<&str>()?);
    found.ok_or_else(|| rejected("the encoding of a number is unknown"))
}

fn order(word: &str) -> Order {
    if word == "little" {
        Order::Little
    } else {
        Order::Big
    }
}

fn command(record: CommandRecord) -> Command {
    let variants = |records: Vec<VariantRecord>| records.into_iter().map(variant).collect();
    Command {
        id: record.id,
        request: variants(record.request),
        reply: variants(record.reply),
    }
}

fn variant(record: VariantRecord) -> Variant {
    Variant::new(record.fields.into_iter().map(field).collect())
}

fn field(record: FieldRecord) -> Field {
    Field {
        flag: record.kind == "flag",
        many: record.many,
        choices: record.choices,
        selector: usize::try_from(record.selector).ok(),
        cases: record.cases.into_iter().map(case).collect(),
        shape: shape(&record.kind, &record.encoding, record.padding),
        each: record.each,
        varies: record.sizes.is_some(),
    }
}

fn shape(kind: &str, encoding: &str, padding: i64) -> Shape {
    let encoding = match encoding {
        "ascii" => Encoding::Ascii,
        "latin-1" => Encoding::Latin1,
        _ => Encoding::Utf8,
    };
    match kind {
        "bytes" => Shape::Bytes,
        "text" => Shape::Text(encoding, u8::try_from(padding).ok()),
        _ => Shape::Numbers,
    }
}

fn case(record: CaseRecord) -> Case {
    Case {
        when: record.when,
        numbers: record.numbers.into_iter().map(number).collect(),
    }
}

fn number(record: NumberRecord) -> Number {
    Number {
        width: record.width,
        order: order(&record.order),
        signed_at: record.signed_at,
        multiply: record.multiply,
        divide: record.divide,
        minimum: record.minimum,
        maximum: record.maximum,
        encoding: record.encoding,
        choices: record.choices,
        flag: record.kind == "flag",
        bits: (record.bits > 0).then_some(Bits {
            shift: record.shift,
            count: record.bits,
            more: record.more,
        }),
    }
}
