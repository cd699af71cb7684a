//! Reads from a packet's comment when its bytes arrived, if they did not arrive at once.

use super::damage::Fault;
use super::packet::Packet;

const MARK: &[u8] = b"in pieces: ";
const SEPARATOR: &[u8] = b"; ";
/// The most digits of a number, so that it fits 64 bits.
const DIGITS: usize = 19;

/// Bytes of a packet that arrived together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub(crate) size: u64,
    /// When they came, in nanoseconds since 1970.
    pub(crate) time: i64,
}

/// Put the pieces of a packet into `pieces`, as the last list in its comment states them that
/// covers all of its bytes. If there is no such list, `pieces` is empty.
#[inline]
pub(crate) fn read(packet: &Packet<'_>, pieces: &mut Vec<Piece>) -> Result<(), Fault> {
    pieces.clear();
    if packet.comment.is_empty() {
        return Ok(());
    }
    for (size, late) in last_list(packet.comment, packet.data.len()) {
        let time = packet.time.checked_add_unsigned(late);
        let time = time.ok_or(Fault::TimeRange)?;
        pieces.push(Piece { size, time });
    }
    Ok(())
}

/// Return the sizes of the pieces, and how many nanoseconds after the packet's time each came.
fn last_list(comment: &[u8], size: usize) -> Vec<(u64, u64)> {
    let mut last = Vec::new();
    for part in parts(comment) {
        let Some(list) = part.strip_prefix(MARK) else {
            continue;
        };
        let found = find(list);
        let add = |sum: u64, (size, _): &(u64, u64)| sum.saturating_add(*size);
        if found.iter().fold(0, add) == size as u64 {
            last = found;
        }
    }
    last
}

fn parts(comment: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(comment);
    std::iter::from_fn(move || {
        let all = rest?;
        let end = all.windows(SEPARATOR.len()).position(|at| at == SEPARATOR);
        rest = end.and_then(|end| all.get(end + SEPARATOR.len()..));
        all.get(..end.unwrap_or(all.len()))
    })
}

/// Find everything of the form `8 bytes at +0 ns`.
fn find(list: &[u8]) -> Vec<(u64, u64)> {
    let (mut found, mut rest) = (Vec::new(), list);
    while let Some(start) = rest.iter().position(u8::is_ascii_digit) {
        rest = rest.get(start..).unwrap_or_default();
        match piece(rest) {
            Some((piece, after)) => {
                found.push(piece);
                rest = after;
            }
            None => rest = without_digits(rest),
        }
    }
    found
}

fn piece(text: &[u8]) -> Option<((u64, u64), &[u8])> {
    let (size, text) = number(text)?;
    let (late, text) = number(text.strip_prefix(b" bytes at +")?)?;
    Some(((size, late), text.strip_prefix(b" ns")?))
}

fn number(text: &[u8]) -> Option<(u64, &[u8])> {
    let rest = without_digits(text);
    let digits = text.get(..text.len() - rest.len())?;
    if !(1..=DIGITS).contains(&digits.len()) {
        return None;
    }
    let add = |number: u64, digit: &u8| number * 10 + u64::from(digit - b'0');
    Some((digits.iter().fold(0, add), rest))
}

fn without_digits(text: &[u8]) -> &[u8] {
    let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    text.get(digits..).unwrap_or_default()
}
