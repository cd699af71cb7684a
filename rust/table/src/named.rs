//! Requests by the names of their arguments.

use alloc::string::String;
use alloc::vec::Vec;

use crate::shown::join;
use crate::texts::text;
use crate::{Edition, Field, Shown};

impl Edition {
    /// Return the values of the request's variant that takes exactly the given arguments, in the
    /// order of the wire, and the index of the variant. If several variants take them, the index is
    /// `None`, and the values must decide. `filled` makes the value of a constant or a default. For
    /// a field that counts elements, it gets `None` and returns a mark: the encoder counts them.
    ///
    /// # Errors
    /// No variant takes exactly these arguments; the text names a missing or an unknown one.
    pub fn arrange<V: Clone>(
        &self,
        command: usize,
        given: &[(&str, V)],
        filled: impl Fn(Option<Shown>) -> V,
    ) -> Result<(Vec<V>, Option<usize>), String> {
        let Some(record) = self.commands.get(command) else {
            return Ok((Vec::new(), None));
        };
        let rows = record.request.iter().map(|each| row(each, given, &filled));
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
fn row<'a, V: Clone>(
    fields: &'a [Field],
    given: &[(&'a str, V)],
    filled: &impl Fn(Option<Shown>) -> V,
) -> Result<Vec<V>, (&'static str, &'a str)> {
    let odd = |(name, _): &&(&str, V)| !fields.iter().any(|field| field.name == *name);
    if let Some((name, _)) = given.iter().find(odd) {
        return Err(("odd-argument", name));
    }
    let value = |field: &'a Field| {
        let own = |(name, _): &&(&str, V)| !field.constant && field.name == *name;
        match (&field.counts, given.iter().find(own), &field.default) {
            (Some(_), ..) => Ok(filled(None)),
            (_, Some((_, value)), _) => Ok(value.clone()),
            (_, _, Some(default)) => Ok(filled(Some(default.clone()))),
            _ => Err(("missing-argument", &*field.name)),
        }
    };
    fields.iter().map(value).collect()
}
