//! Reads the commands of a file.

use alloc::vec;
use alloc::vec::Vec;

use cobotwire_core as wire;
use cobotwire_core::exchange::{Facts, Named, Nanos, Safety, TextForm};

use crate::Command;
use crate::json::{BadEdition, Node, Outcome, Record, Within};
use crate::messages::{Messages, Variant};

/// The longest time of a file, in milliseconds: a day.
const LONGEST_MS: i64 = 24 * 3600 * 1000;

/// A command as the table, the exchange, and texts and clients need it.
pub(crate) type Parts = (wire::Command, Facts, Command);

/// Return a command; its id is at most `last`.
pub(crate) fn command<'a>(
    record: Record<'a>,
    messages: &mut Messages<'a>,
    last: i64,
) -> Outcome<Parts> {
    let event = record.is("event")?;
    let mut requests = lists(record, "request")?;
    if record.get("request").is_none() && !event {
        requests.push(Vec::new());
    }
    let request = messages.variants(requests).within("request", "")?;
    let replies = lists(record, "reply")?;
    let reply = messages.variants(replies).within("reply", "")?;
    let facts = Facts {
        safety: safety(record.need("safety")?)?,
        deadline: millis(record.need("deadline_ms")?)?,
        ack: record.is("ack")?,
        event,
        text: record
            .get("text")
            .map(text)
            .transpose()
            .within("text", "")?,
        request_text: record
            .get("request_text")
            .map(text)
            .transpose()
            .within("request_text", "")?,
        request: request.iter().map(named).collect(),
        reply: reply.iter().map(named).collect(),
        accepted: record.integers("accepted")?,
        statuses: reply.iter().map(statuses).collect(),
    };
    let (in_request, request) = parted(request);
    let (in_reply, reply) = parted(reply);
    let id = u16::try_from(record.within("id", 0..=last)?).unwrap_or_default();
    let command = Command {
        id,
        name: record.name()?.into(),
        family: record.text("family")?.into(),
        safety: facts.safety,
        role: record.text("role")?.into(),
        arguments: record.texts("arguments")?,
        read_by: match record.get("read_by") {
            Some(back) => Some(back.record()?.need("query")?.string()?),
            None => None,
        },
        stores: stores(record)?,
        request: in_request,
        reply: in_reply,
    };
    Ok((wire::Command { id, request, reply }, facts, command))
}

fn lists<'a>(record: Record<'a>, key: &'a str) -> Outcome<Vec<Vec<Record<'a>>>> {
    record.list(key)?.map(Node::records).collect()
}

fn parted(variants: Vec<Variant>) -> (Vec<Vec<crate::Field>>, Vec<wire::Variant>) {
    let parts = variants.into_iter();
    parts
        .map(|each| (each.texts, wire::Variant::new(each.fields)))
        .unzip()
}

fn named(variant: &Variant) -> Vec<Named> {
    let named = |field: &crate::Field| Named {
        name: field.name.as_str().into(),
        echo: field.echo,
    };
    variant.texts.iter().map(named).collect()
}

/// Return the indices of the fields that report success or failure.
fn statuses(variant: &Variant) -> Vec<usize> {
    let fields = variant.fields.iter().zip(&variant.texts).enumerate();
    let own =
        fields.filter(|(_, (field, text))| field.choices.len() != 1 || !text.labels.is_empty());
    own.map(|(index, _)| index).collect()
}

fn safety(word: Node<'_>) -> Outcome<Safety> {
    Ok(match word.text()? {
        "query" => Safety::Query,
        "setting" => Safety::Setting,
        "motion" => Safety::Motion,
        "power" => Safety::Power,
        "persistent write" => Safety::Persistent,
        _ => return Err(word.unknown("query, setting, motion, power, persistent write")),
    })
}

fn millis(node: Node<'_>) -> Outcome<Nanos> {
    let millis = Nanos::try_from(node.within(0..=LONGEST_MS)?).unwrap_or_default();
    Ok(millis * 1_000_000)
}

fn text(node: Node<'_>) -> Outcome<TextForm> {
    let record = node.record()?;
    let (mut prefixes, mut fields) = (vec![], vec![]);
    for prefix in record.list("prefixes")? {
        prefixes.push(prefix.text()?.into());
    }
    for field in record.records("fields")? {
        fields.push(field.name()?.into());
    }
    if prefixes.len() != fields.len() {
        return Err(BadEdition::new("prefixes must be as many as fields"));
    }
    Ok(TextForm {
        prefixes,
        fields,
        suffix: record.text("suffix")?.into(),
        silence: record.get("silence_ms").map_or(Ok(0), millis)?,
    })
}

/// Return the states that a command stores.
fn stores(record: Record<'_>) -> Outcome<Vec<alloc::string::String>> {
    let Some(effect) = record.get("effect") else {
        return Ok(Vec::new());
    };
    let Some(stores) = effect.record()?.get("stores") else {
        return Ok(Vec::new());
    };
    stores.record()?.values()
}
