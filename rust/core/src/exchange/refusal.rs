//! Acknowledgements by which the arm reports that it did not carry out a request.

use alloc::vec::Vec;

use super::facts::{Named, Protocol};
use super::outcome::Failure;
use super::values::{fields, same};
use crate::decode::Decoded;
use crate::message::VariantId;
use crate::number::Value;

/// Return the status by which a reply reports that it failed; `None`: it reports success.
///
/// Without accepted values, each field that is 0 reports it; constants and repeated arguments do not
/// count.
pub(super) fn refusal(protocol: &Protocol, reply: &Decoded) -> Option<Failure> {
    let (command, facts) = protocol.command(reply.variant.command)?;
    let names = facts.reply.get(reply.variant.variant)?;
    let found: Vec<(&Named, &[Value])> = fields(names, reply).collect();
    let value = |name: &str| {
        let (_, value) = found.iter().find(|(named, _)| *named.name == *name)?;
        Some(*value)
    };
    // The last variant with these fields counts.
    let (index, names, statuses) = facts
        .reply
        .iter()
        .zip(&facts.statuses)
        .enumerate()
        .rev()
        .map(|(index, (names, statuses))| (index, names, statuses))
        .find(|(_, names, statuses)| {
            let status = |at: &usize| names.get(*at).is_some_and(|own| value(&own.name).is_some());
            let has = |name: &str| names.iter().any(|own| *own.name == *name);
            statuses.iter().all(status) && found.iter().all(|(named, _)| has(&named.name))
        })?;
    let variant = command.reply.get(index)?;
    let refused = |field: usize, value: &[Value]| {
        Some(Failure::Refused {
            variant: VariantId {
                variant: index,
                ..reply.variant
            },
            field,
            value: *value.first()?,
        })
    };
    if !facts.accepted.is_empty() {
        let last = *statuses.last()?;
        let value = value(&names.get(last)?.name)?;
        let mut accepted = facts.accepted.iter();
        let is = accepted.any(|raw| same(value, &[Value::Integer(*raw)]));
        return if is { None } else { refused(last, value) };
    }
    statuses.iter().find_map(|at| {
        let (named, value) = (names.get(*at)?, value(&names.get(*at)?.name)?);
        let counts = !named.echo && !variant.fields().get(*at)?.many;
        let zero = counts && same(value, &[Value::Integer(0)]);
        // It is reported as the integer, whatever the scale of the field is.
        if zero {
            refused(*at, &[Value::Integer(0)])
        } else {
            None
        }
    })
}
