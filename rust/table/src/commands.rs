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
    messages: &mut Messages<'a>,
    last: u16,
) -> Outcome<Parts> {
    let event: bool = record.any("event")?;
    let mut lists = record.records("request")?;
    if record.some("request").is_none() && !event {
        lists.push(record.at("request"));
    }
    let request = messages.variants(lists).within("request", "")?;
    let reply = messages
        .variants(record.records("reply")?)
        .within("reply", "")?;
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
        statuses: reply.iter().map(statuses).collect(),
    };
    let (in_request, request) = parted(request);
    let (in_reply, reply) = parted(reply);
    let id = record.within("id", 0..=last)?;
    let stores: BTreeMap<String, String> = record.at("effect").any("stores")?;
    let command = Command {
        id,
        name: record.get("name")?,
        family: record.any("family")?,
        safety: facts.safety,
        role: record.any("role")?,
        read_by: match record.some("read_by") {
            Some(back) => back.get("query")?,
            None => None,
        },
        stores: stores.into_values().collect(),
        request: in_request,
        reply: in_reply,
    };
    Ok((wire::Command { id, request, reply }, facts, command))
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
        silence: match record.some("silence_ms") {
            Some(_) => record.within("silence_ms", 0..=LONGEST_MS)? * 1_000_000,
            None => 0,
        },
    };
    if form.prefixes.len() != form.fields.len() {
        return BadEdition::because("prefixes must be as many as fields").within(key, "");
    }
    Ok(Some(form))
}
