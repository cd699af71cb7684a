//! Requests by the names of their arguments.

use alloc::string::String;
use alloc::vec::Vec;

use crate::texts::text;
use crate::value::join;
use crate::{Edition, Field, Value};

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

/// Return the values of a variant; or the kind of an error, and the argument at fault.
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
