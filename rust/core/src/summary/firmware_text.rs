//! Describes lines of text, as Python's `cobotwire.diagnose.firmware` does.

use super::repr;

/// This many characters of a text are shown.
const SHOWN: usize = 60;
const CUT: &[u8] = b"...";

/// Append text and facts of a line, which is ASCII.
pub(super) fn append(out: &mut Vec<u8>, line: &[u8]) {
    out.extend_from_slice(b"\"text\": ");
    let mut text = b"text: ".to_vec();
    quote(&mut text, &shown(line));
    repr::text(out, text.into_iter().map(char::from));
    out.extend_from_slice(b", \"facts\": {\"text\": ");
    repr::text(out, line.iter().copied().map(char::from));
    out.push(b'}');
}

/// Return the line without its line ends, cut if it is long.
fn shown(line: &[u8]) -> Vec<u8> {
    let is_end = |byte: &u8| matches!(byte, b'\r' | b'\n');
    let start = line.iter().take_while(|byte| is_end(byte)).count();
    let text = line.get(start..).unwrap_or_default();
    let ends = text.iter().rev().take_while(|byte| is_end(byte)).count();
    let text = text.get(..text.len() - ends).unwrap_or_default();
    match text.get(..SHOWN - CUT.len()) {
        Some(start) if text.len() > SHOWN => [start, CUT].concat(),
        _ => text.to_vec(),
    }
}

/// Append a text in quotes, with control characters as Python's `repr` writes them.
fn quote(out: &mut Vec<u8>, text: &[u8]) {
    let double = text.contains(&b'\'') && !text.contains(&b'"');
    let mark = if double { b'"' } else { b'\'' };
    out.push(mark);
    for byte in text {
        match byte {
            b'\\' => out.extend_from_slice(b"\\\\"),
            b'\t' => out.extend_from_slice(b"\\t"),
            b'\n' => out.extend_from_slice(b"\\n"),
            b'\r' => out.extend_from_slice(b"\\r"),
            b' '..=b'~' if *byte != mark => out.push(*byte),
            b' '..=b'~' => out.extend_from_slice(&[b'\\', *byte]),
            _ => out.extend_from_slice(format!("\\x{byte:02x}").as_bytes()),
        }
    }
    out.push(mark);
}
