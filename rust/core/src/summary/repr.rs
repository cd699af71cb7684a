//! Writes numbers as Python does.

/// Below this number, doubles distinguish all decimal numbers with 15 digits.
const EXACT: f64 = 1e15;
/// Most values are multiples of a thousandth.
const FINE: f64 = 1000.0;

/// Append an integer.
pub(super) fn integer(out: &mut Vec<u8>, integer: i64) {
    if integer < 0 {
        out.push(b'-');
    }
    natural(out, integer.unsigned_abs());
}

/// Append an integer that is not negative.
pub(super) fn natural(out: &mut Vec<u8>, mut rest: u64) {
    let start = out.len();
    loop {
        out.push(b'0' + (rest % 10) as u8);
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    if let Some(digits) = out.get_mut(start..) {
        digits.reverse();
    }
}

/// Append a double as JSON, as Python writes it: the shortest decimal that reads back as the same
/// double.
pub(super) fn real(out: &mut Vec<u8>, real: f64) {
    let thousandths = (real * FINE).round();
    // At most one decimal number with up to 15 digits reads back as a given double.
    if thousandths.abs() < EXACT && thousandths / FINE == real && real != 0.0 {
        decimal(out, real < 0.0, thousandths.abs() as u64);
    } else {
        general(out, real);
    }
}

/// Append a number of thousandths.
fn decimal(out: &mut Vec<u8>, negative: bool, thousandths: u64) {
    if negative {
        out.push(b'-');
    }
    natural(out, thousandths / 1000);
    out.push(b'.');
    let rest = thousandths % 1000;
    for digit in [rest / 100, rest / 10 % 10, rest % 10] {
        out.push(b'0' + digit as u8);
    }
    while out.ends_with(b"0") && !out.ends_with(b".0") {
        out.pop();
    }
}

/// Append any double.
fn general(out: &mut Vec<u8>, real: f64) {
    if !real.is_finite() {
        let word = if real.is_nan() { "NaN" } else { "Infinity" };
        out.extend_from_slice(if real < 0.0 { b"-" } else { b"" });
        out.extend_from_slice(word.as_bytes());
        return;
    }
    if real.is_sign_negative() {
        out.push(b'-');
    }
    // Rust's digits are those of Python; only the layout differs.
    let shortest = format!("{:e}", real.abs());
    let (mantissa, exponent) = shortest.split_once('e').unwrap_or((&shortest, "0"));
    let digits = mantissa.replace('.', "");
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let text = match usize::try_from(exponent) {
        Ok(whole) if whole < 16 => {
            let (before, after) = digits.split_at_checked(whole + 1).unwrap_or((&digits, ""));
            let after = if after.is_empty() { "0" } else { after };
            format!("{before:0<width$}.{after}", width = whole + 1)
        }
        Err(_) if exponent >= -4 => {
            let zeros = usize::try_from(-exponent - 1).unwrap_or_default();
            format!("0.{}{digits}", "0".repeat(zeros))
        }
        _ => {
            let sign = if exponent < 0 { '-' } else { '+' };
            format!("{mantissa}e{sign}{:02}", exponent.abs())
        }
    };
    out.extend_from_slice(text.as_bytes());
}

/// Append a text in quotes, in ASCII.
pub(super) fn text(out: &mut Vec<u8>, text: impl Iterator<Item = char>) {
    out.push(b'"');
    characters(out, text);
    out.push(b'"');
}

/// Append what is between the quotes of a text.
pub(super) fn characters(out: &mut Vec<u8>, text: impl Iterator<Item = char>) {
    for char in text {
        match char {
            '"' => out.extend_from_slice(b"\\\""),
            '\\' => out.extend_from_slice(b"\\\\"),
            '\n' => out.extend_from_slice(b"\\n"),
            '\r' => out.extend_from_slice(b"\\r"),
            '\t' => out.extend_from_slice(b"\\t"),
            '\u{8}' => out.extend_from_slice(b"\\b"),
            '\u{c}' => out.extend_from_slice(b"\\f"),
            ' '..='~' => out.push(char as u8),
            _ => {
                for unit in char.encode_utf16(&mut [0; 2]) {
                    out.extend_from_slice(format!("\\u{unit:04x}").as_bytes());
                }
            }
        }
    }
}

/// Append a list.
pub(super) fn list<T>(
    out: &mut Vec<u8>,
    elements: impl Iterator<Item = T>,
    write: impl Fn(&mut Vec<u8>, T),
) {
    out.push(b'[');
    for (index, element) in elements.enumerate() {
        if index > 0 {
            out.extend_from_slice(b", ");
        }
        write(out, element);
    }
    out.push(b']');
}

/// Append a value, or `null`.
pub(super) fn optional<T>(out: &mut Vec<u8>, value: Option<T>, write: impl Fn(&mut Vec<u8>, T)) {
    match value {
        Some(value) => write(out, value),
        None => out.extend_from_slice(b"null"),
    }
}

/// Append bytes as pairs of hex digits, with spaces.
pub(super) fn hex(out: &mut Vec<u8>, pieces: impl Iterator<Item = u8>) {
    const DIGITS: [u8; 16] = *b"0123456789ABCDEF";
    let digit = |value: u8| DIGITS.get(usize::from(value)).copied().unwrap_or_default();
    let start = out.len();
    for byte in pieces {
        out.extend_from_slice(&[digit(byte >> 4), digit(byte & 15), b' ']);
    }
    if out.len() > start {
        out.pop();
    }
}
