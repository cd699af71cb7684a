//! Turns the commands of a file into those of a table, and arguments with names into its values.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use cobotwire_core as wire;
use cobotwire_core::exchange::{Facts, Nanos, Safety, TextForm};

use crate::json::{Record, Word};
use crate::messages::Messages;
use crate::texts::text;
use crate::value::join;
use crate::{BadEdition, Command, Edition, Field, Outcome, Value, Within};

/// The longest time that a file may state, in milliseconds: a day.
const LONGEST_MS: Nanos = 24 * 3600 * 1000;

/// A command in the forms that the table, the exchange and the clients need.
pub(crate) type Parts = (wire::Command, Facts, Command);

impl Word for Safety {
    const WORDS: &[(&str, Self)] = &[
        ("query", Self::Query),
        ("setting", Self::Setting),
        ("motion", Self::Motion),
        ("power", Self::Power),
        ("persistent write", Self::Persistent),
    ];
}

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
    let (request, (request_texts, request_names)) = request.into_iter().unzip();
    let (reply, (reply_texts, reply_names)) = reply.into_iter().unzip();
    let facts = Facts {
        safety: record.word("safety")?,
        deadline: record.within("deadline_ms", 0..=LONGEST_MS)? * 1_000_000,
        ack: record.any("ack")?,
        event,
        text: text_form(record, "text")?,
        request_text: text_form(record, "request_text")?,
        request: request_names,
        reply: reply_names,
        accepted: record.any("accepted")?,
    };
    let stores: BTreeMap<String, String> = record.at("effect").any("stores")?;
    let command = Command {
        name: record.get("name")?,
        title: record.any("title")?,
        family: record.any("family")?,
        safety: facts.safety,
        role: record.any("role")?,
        read_by: record.at("read_by").get("query")?,
        stores: stores.into_values().collect(),
        request: request_texts,
        reply: reply_texts,
    };
    let id = record.within("id", 0..=last)?;
    Ok((wire::Command { id, request, reply }, facts, command))
}

fn text_form(record: Record<'_>, key: &str) -> Outcome<Option<TextForm>> {
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
        return BadEdition::because("there must be as many prefixes as fields").within(key, "");
    }
    Ok(Some(form))
}

impl Edition {
    /// Return the values of the request's variant that takes exactly the given arguments, in the
    /// order of the wire, and the index of the variant. If several variants take them, the index is
    /// `None`, and the values must decide.
    ///
    /// # Errors
    /// No variant takes exactly these arguments; the text names a missing or an unknown one.
    pub fn arrange(
        &self,
        command: usize,
        given: &[(&str, Value)],
    ) -> Result<(Vec<Value>, Option<usize>), String> {
        let Some(record) = self.commands.get(command) else {
            return Ok((Vec::new(), None));
        };
        let rows = record.request.iter().map(|each| row(each, given));
        let (fitting, misfits): (Vec<_>, Vec<_>) = rows.enumerate().partition(|row| row.1.is_ok());
        if let [(index, Ok(row)), others @ ..] = &*fitting {
            return Ok((row.clone(), others.is_empty().then_some(*index)));
        }
        let mut misfits = misfits.into_iter();
        let (kind, name) = misfits.find_map(|row| row.1.err()).unwrap_or_default();
        let fields = record.request.first().into_iter().flatten();
        let fields = fields.filter(|field| !field.constant && field.counts.is_none());
        let mut allowed = join(fields.map(|field| field.name.clone()), ", ");
        if allowed.is_empty() {
            allowed = text!("no-arguments");
        }
        Err(text!(kind; call = record.name, name, allowed))
    }
}

/// Return the values of a variant, or the kind of the error and the wrong argument.
fn row<'a>(
    fields: &'a [Field],
    given: &[(&'a str, Value)],
) -> Result<Vec<Value>, (&'static str, &'a str)> {
    let odd = |(name, _): &&(&str, Value)| !fields.iter().any(|field| field.name == *name);
    if let Some((name, _)) = given.iter().find(odd) {
        return Err(("odd-argument", name));
    }
    let value = |field: &'a Field| {
        let own = |(name, _): &&(&str, Value)| !field.constant && field.name == *name;
        match (
            &field.counts,
            given.iter().find(own).map(|(_, value)| value),
            &field.default,
        ) {
            (Some(_), ..) => Ok(Value::Counted),
            (_, Some(value), _) | (_, _, Some(value)) => Ok(value.clone()),
            _ => Err(("missing-argument", &*field.name)),
        }
    };
    fields.iter().map(value).collect()
}
