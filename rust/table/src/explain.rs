//! Explains each byte of a frame; `frame_parts` of `python/cobotwire/diagnose/explain.py` is
//! the specification.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::Range;

use cobotwire_core::{self as wire, Check, Decoded, Shape};

use crate::rejection::{Part, UNITS};
use crate::texts::{entry, hex, text};
use crate::value::general;
use crate::{Edition, Value};

/// Adjacent bytes of a frame, and what they mean. If bit fields share bytes, `bytes` is empty for
/// all of them but the last.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Explained {
    pub bytes: Range<usize>,
    pub name: String,
    pub meaning: String,
    /// The raw value of a number.
    pub raw: Option<i64>,
}

impl Edition {
    /// Return every byte of a legal frame with its meaning, in order.
    #[must_use]
    pub fn explain(&self, frame: &[u8], message: &Decoded) -> Vec<Explained> {
        let (id, format) = (message.variant, self.protocol.table.frame());
        let layout = format.layout;
        let mut parts: Vec<Explained> = Vec::new();
        let mut push = |bytes, name: &str, meaning, raw| {
            parts.push(Explained {
                bytes,
                name: name.into(),
                meaning,
                raw,
            });
        };
        push(
            0..format.header.len(),
            "header",
            "a frame starts here".into(),
            None,
        );
        if let Some((at, address)) = layout.address_at.zip(message.address) {
            push(at..at + 1, "address", self.address_name(address), None);
        }
        let (end, length) = (layout.length.end(), layout.length.read(frame));
        let mut meaning = length.unwrap_or_default().to_string();
        if end == layout.overhead {
            meaning = format!("{meaning}: {meaning} bytes follow");
        }
        push(layout.length.at..end, "LEN", meaning, None);
        if let Some(command) = self.commands.get(id.command)
            && format.has_id(id.direction)
        {
            let colon = if command.title.is_empty() { "" } else { ": " };
            let meaning = format!("{}{colon}{}", command.name, command.title);
            push(layout.id.at..layout.id.end(), "CMD", meaning, None);
        }
        let mut at = format.data_start(id.direction);
        let data = frame.get(at..).unwrap_or_default();
        let named = self.named(message);
        for (index, (name, value)) in named.into_iter().enumerate() {
            let case = self.protocol.table.case(id, index, data);
            let Some(part) = case.and_then(|case| self.part(id, index, case)) else {
                continue;
            };
            if part.wire.shape != Shape::Numbers {
                let meaning = match value {
                    Value::Bytes(bytes) if bytes.is_empty() => "no bytes".into(),
                    Value::Bytes(bytes) => hex(&bytes, " "),
                    text => text.to_string(),
                };
                push(at..at + part.numbers.len(), &name, meaning, None);
                at += part.numbers.len();
                continue;
            }
            for (element, number) in part.numbers.iter().enumerate() {
                let (raw, end) = (number.unpack(frame, at), at + number.step());
                let meaning = part.meaning(element, raw);
                push(at..end, &part.element(element), meaning, Some(raw));
                at = end;
            }
        }
        let name = match format.check {
            Check::Computed(ref computed) if computed.algorithm.is_some() => "check",
            _ => "footer",
        };
        push(at..frame.len(), name, "the frame ends here".into(), None);
        // The edition decides the order of address, LEN and CMD.
        parts.sort_by_key(|part| part.bytes.start);
        parts
    }
}

impl Part<'_> {
    /// Return a number with its unit or label.
    fn meaning(&self, at: usize, raw: i64) -> String {
        let Some((number, names)) = self.numbers.get(at).zip(self.named(at)) else {
            return String::new();
        };
        if self.wire.flag || number.flag {
            return if raw == 0 { "no" } else { "yes" }.into();
        }
        let (labels, choices) = self.labels(number, names);
        let at = choices.iter().position(|choice| *choice == raw);
        if let Some(label) = at.and_then(|at| labels.get(at)) {
            return text!("label"; label, raw);
        }
        let value = match number.physical(raw) {
            wire::Value::Real(real) => general(real, 6),
            _ => raw.to_string(),
        };
        let unit = entry(UNITS, &names.unit).unwrap_or(&names.unit);
        format!("{value} {unit}").trim_end().into()
    }
}
