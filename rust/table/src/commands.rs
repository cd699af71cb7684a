//! Turns the commands of a file into those of a table.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use cobotwire_core as wire;
use cobotwire_core::exchange::{Facts, Named, Nanos, TextForm};

use crate::json::Record;
use crate::messages::{Messages, Variant};
use crate::{BadEdition, Command, Outcome, Within};

/// The longest time of a file, in milliseconds: a day.
const LONGEST_MS: Nanos = 24 * 3600 * 1000;

/// A command as the table, the exchange, and texts and clients need it.
pub(crate) type Parts = (wire::Command, Facts, Command);

/// Return a command; its id is at most `last`.
pub(crate) fn command<'a>(
    record: Record<'a>,
    messages: &Messages<'a>,
    last: u16,
) -> Outcome<Parts> {
    let event: bool = record.any("event")?;
    let mut lists = record.records("request")?;
    if record.some("request").is_none() && !event {
        lists.push(record.at("request"));
    }
    let request = messages.variants(lists).within("request", "")?;
    let reply = messages.variants(record.records("reply")?);
    let reply = reply.within("reply", "")?;
    let facts = Facts {
        safety: record.get("safety")?,
        deadline: record.within("deadline_ms", 0..=LONGEST_MS)? * 1_000_000,
        ack: record.any("ack")?,
        event,
        text: text(record, "text")?,
        request_text: text(record, "request_text")?,
        request: request.iter().map(named).collect(),
        reply: reply.iter().map(named).collect(),
        accepted: record.any("accepted")?,
    };
    let (in_request, request) = request.into_iter().map(parts).unzip();
    let (in_reply, reply) = reply.into_iter().map(parts).unzip();
    let stores: BTreeMap<String, String> = record.at("effect").any("stores")?;
    let command = Command {
        name: record.get("name")?,
        title: record.any("title")?,
        family: record.any("family")?,
        safety: facts.safety,
        role: record.any("role")?,
        read_by: record.at("read_by").get("query")?,
        stores: stores.into_values().collect(),
        request: in_request,
        reply: in_reply,
    };
    let id = record.within("id", 0..=last)?;
    Ok((wire::Command { id, request, reply }, facts, command))
}

fn parts(variant: Variant) -> (Vec<crate::Field>, wire::Variant) {
    (variant.texts, wire::Variant::new(variant.fields))
}

fn named(variant: &Variant) -> Vec<Named> {
    let fields = variant.fields.iter().zip(&variant.texts);
    let named = fields.map(|(field, text)| Named {
        name: text.name.as_str().into(),
        echo: text.echo,
        status: field.choices.len() != 1 || !text.labels.is_empty(),
    });
    named.collect()
}

fn text(record: Record<'_>, key: &str) -> Outcome<Option<TextForm>> {
    let Some(record) = record.some(key) else {
        return Ok(None);
    };
    let fields = record.records("fields")?.into_iter();
    let fields = fields.map(|each| each.name().map(Box::from));
    let form = TextForm {
        prefixes: record.any("prefixes")?,
        fields: fields.collect::<Outcome<_>>()?,
        suffix: record.any("suffix")?,
        silence: record.within_or("silence_ms", 0..=LONGEST_MS, 0)? * 1_000_000,
    };
    if form.prefixes.len() != form.fields.len() {
        return BadEdition::because("prefixes must be as many as fields").within(key, "");
    }
    Ok(Some(form))
}
