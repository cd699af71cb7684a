//! Text outside any frame: `prefix field prefix field suffix`, in ASCII.

use alloc::string::String;
use alloc::vec::Vec;

use super::{Nanos, TextForm};

/// The longest text. The names and passwords of networks are shorter: at most 32 and 63 characters.
const LIMIT: usize = 4096;
/// The error shows at most this many bytes of a longer text.
const SHOWN: usize = 64;

/// What is wrong with a text that was received, and the index of the wrong byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct TextError {
    pub mistake: TextMistake,
    pub offset: usize,
}

/// What is wrong with a text that was received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextMistake {
    /// A byte is not ASCII.
    NotAscii,
    /// It does not start with the first prefix.
    Start,
    /// It does not end with the suffix.
    End,
    /// The prefix of this index occurs in the rest of the text this many times, not once.
    Prefix(usize, usize),
    /// It is longer than allowed; the offset is the limit.
    TooLong,
}

/// Why texts of a caller cannot be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFault {
    /// The one with this index is not printable ASCII.
    NotPrintable(usize),
    /// They contain one of the texts that separate them, so they would be decoded differently.
    Ambiguous,
}

impl TextForm {
    /// Return the bytes of a text; a missing value is empty.
    pub(super) fn encode(&self, values: &[&str]) -> Result<Vec<u8>, TextFault> {
        let value = |index: usize| values.get(index).copied().unwrap_or_default();
        let printable = |text: &str| text.bytes().all(|byte| matches!(byte, b' '..=b'~'));
        let count = self.fields.len();
        if let Some(index) = (0..count).find(|index| !printable(value(*index))) {
            return Err(TextFault::NotPrintable(index));
        }
        let mut data = Vec::new();
        for (index, prefix) in self.prefixes.iter().enumerate().take(count) {
            data.extend_from_slice(prefix.as_bytes());
            data.extend_from_slice(value(index).as_bytes());
        }
        data.extend_from_slice(self.suffix.as_bytes());
        let meant = (0..count).map(value);
        match self.decode(&data) {
            Ok(read) if meant.eq(read.iter().map(String::as_str)) => Ok(data),
            _ => Err(TextFault::Ambiguous),
        }
    }

    /// Return the fields of a text. They may contain spaces; a final line end is dropped.
    pub(super) fn decode(&self, data: &[u8]) -> Result<Vec<String>, TextError> {
        let wrong = |mistake, offset| TextError { mistake, offset };
        if let Some(at) = data.iter().position(|byte| !byte.is_ascii()) {
            return Err(wrong(TextMistake::NotAscii, at));
        }
        let text = core::str::from_utf8(data).unwrap_or_default();
        let text = text.trim_end_matches(['\r', '\n']);
        let (first, suffix) = (self.first_prefix(), &*self.suffix);
        let after = text
            .strip_prefix(first)
            .ok_or(wrong(TextMistake::Start, 0))?;
        let unended = wrong(TextMistake::End, data.len());
        let mut rest = after.strip_suffix(suffix).ok_or(unended)?;
        let mut values = Vec::new();
        for (index, prefix) in self.prefixes.iter().enumerate().skip(1) {
            let (times, offset) = (rest.matches(&**prefix).count(), text.len() - rest.len());
            match rest.split_once(&**prefix) {
                Some((value, after)) if times == 1 => {
                    values.push(value.into());
                    rest = after;
                }
                _ => return Err(wrong(TextMistake::Prefix(index, times), offset)),
            }
        }
        values.push(rest.into());
        values.truncate(self.fields.len());
        Ok(values)
    }

    fn first_prefix(&self) -> &str {
        self.prefixes.first().map_or("", |prefix| prefix)
    }
}

/// Collects a text reply from noise; only silence shows its end. Bytes that come before its first
/// prefix do not belong to it.
#[derive(Clone, Debug)]
pub(super) struct TextCollector {
    pub(super) form: TextForm,
    data: Vec<u8>,
    /// The time at which the last bytes of a begun text came.
    last: Option<Nanos>,
}

impl TextCollector {
    pub(super) fn new(form: TextForm) -> Self {
        let (data, last) = (Vec::new(), None);
        Self { form, data, last }
    }

    /// Return when the text ends unless more of it comes; `None`: it has not begun.
    pub(super) fn ends_at(&self) -> Option<Nanos> {
        Some(self.last?.saturating_add(self.form.silence))
    }

    /// Take bytes that belong to no frame.
    pub(super) fn add(&mut self, data: &[u8], now: Nanos) {
        if data.is_empty() {
            return;
        }
        self.data.extend_from_slice(data);
        if self.last.is_none() {
            let prefix = self.form.first_prefix().as_bytes();
            let start = find(&self.data, prefix);
            // The prefix may have begun in the last bytes.
            let kept = self.data.len().saturating_sub(prefix.len());
            self.data.drain(..start.unwrap_or(kept));
            if start.is_none() {
                return;
            }
        }
        self.last = Some(now);
        self.data.truncate(LIMIT + 1);
    }

    /// Return the fields of the text; with an error, the bytes that show it.
    pub(super) fn decode(&self) -> Result<Vec<String>, (TextError, Vec<u8>)> {
        if self.data.len() > LIMIT {
            let (mistake, offset) = (TextMistake::TooLong, LIMIT);
            let shown = self.data.get(..SHOWN).unwrap_or_default();
            return Err((TextError { mistake, offset }, shown.into()));
        }
        let read = self.form.decode(&self.data);
        read.map_err(|error| (error, self.data.clone()))
    }
}

/// Return the offset at which `bytes` first occur in `data`.
pub(super) fn find(data: &[u8], bytes: &[u8]) -> Option<usize> {
    (0..=data.len()).find(|at| data.get(*at..).is_some_and(|rest| rest.starts_with(bytes)))
}
