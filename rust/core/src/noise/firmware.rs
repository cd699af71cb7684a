//! Recognises text of the controller's firmware, line by line. Python diagnoses panics and boots.

use super::{Cluster, Kind, Verdict};

/// At least this many readable bytes in a row are text.
const FEWEST: usize = 6;
/// Longer lines are cut.
pub(super) const LINE: usize = 1024;
const PANIC: &[u8] = b"Guru Meditation Error";
const COMMAND_ERROR: &[u8] = b"cmd_len error";
/// A line with this may state the cause of a boot.
const RESET: &[u8] = b"rst:0x";

/// Return whether a byte is text.
pub(super) fn readable(byte: u8) -> bool {
    matches!(byte, b'\t' | b'\n' | b'\r' | 0x1B | b' '..=b'~')
}

/// Return whether bytes begin with an error message.
pub(super) fn starts_message(data: &[u8]) -> bool {
    data.starts_with(PANIC) || data.starts_with(COMMAND_ERROR)
}

/// Recognise the line of text at `at`; directly after other text it may be shorter than [`FEWEST`].
pub(super) fn line(cluster: &Cluster<'_>, at: usize, after_text: bool) -> Verdict {
    let rest = cluster.data.get(at..).unwrap_or_default();
    let readable = |byte: &&u8| readable(**byte);
    // Check the last byte first: the first one is known to be readable, so most random bytes fail
    // at once.
    let enough = rest
        .get(..FEWEST)
        .is_some_and(|six| six.iter().rev().all(|byte| readable(&byte)));
    let first = rest.first().as_ref().is_some_and(readable);
    if !(enough || after_text && first) {
        return None;
    }
    let run = rest.iter().take(LINE + PANIC.len()).take_while(readable);
    let run = rest.get(..run.count()).unwrap_or_default();
    let is_end = |byte: &u8| matches!(byte, b'\r' | b'\n');
    let start = run.iter().take_while(|byte| is_end(byte)).count();
    let text = run.get(start..).unwrap_or_default();
    let size = text.iter().take_while(|byte| !is_end(byte)).count();
    if text.starts_with(PANIC) {
        return Some((Kind::Other, at));
    }
    if text.starts_with(COMMAND_ERROR) {
        return Some(command_error(cluster, at + start + COMMAND_ERROR.len()));
    }
    Some(ordinary(cluster, at, at + start + size))
}

/// Return an ordinary line, up to its end or to an error message in it.
fn ordinary(cluster: &Cluster<'_>, at: usize, end: usize) -> (Kind, usize) {
    let line = cluster.data.get(at + 1..end).unwrap_or_default();
    let marked = [PANIC, COMMAND_ERROR].map(|word| find(line, word));
    if let Some(marked) = marked.into_iter().flatten().min() {
        return text(cluster, at, at + 1 + marked.min(LINE - 1));
    }
    if end - at >= LINE {
        return text(cluster, at, at + LINE);
    }
    let more = cluster.data.get(end).is_some_and(|byte| readable(*byte));
    text(cluster, at, if more { cluster.line_end(end) } else { end })
}

fn text(cluster: &Cluster<'_>, start: usize, end: usize) -> (Kind, usize) {
    let line = cluster.data.get(start..end).unwrap_or_default();
    let boot = find(line, RESET).is_some();
    (if boot { Kind::Other } else { Kind::Text }, end)
}

fn command_error(cluster: &Cluster<'_>, end: usize) -> (Kind, usize) {
    let cut = cluster.segment_end(end - 1) == end;
    let end = if cut { end } else { cluster.line_end(end) };
    (Kind::CommandError, end)
}

fn find(data: &[u8], word: &[u8]) -> Option<usize> {
    let first = word.first()?;
    let mut starts = data.iter().enumerate().filter(|(_, byte)| *byte == first);
    let found = starts.find(|(at, _)| data.get(*at..).is_some_and(|rest| rest.starts_with(word)));
    found.map(|(at, _)| at)
}
