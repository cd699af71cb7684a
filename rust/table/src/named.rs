//! Requests by the names of their arguments.

use alloc::string::String;
use alloc::vec::Vec;

use crate::shown::join;
use crate::texts::text;
use crate::{Edition, Field, Shown};

impl Edition {
    /// Return the values of the request's variant that takes exactly the given arguments, in the
    /// order of the wire, and the index of the variant. If several variants take them, the index is
    /// `None`, and the values must decide. `filled` makes the value of a constant or a default; for
    /// `None` it makes the mark of a field that counts elements: the encoder counts them.
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
        let (mut fitting, mut misfit) = (Vec::new(), None);
        for (index, variant) in record.request.iter().enumerate() {
            match row(variant, given, &filled) {
                Ok(row) => fitting.push((row, Some(index))),
                Err(bad) => misfit = misfit.or(Some(bad)),
            }
        }
        let sure = fitting.len() == 1;
        if let Some((row, index)) = fitting.into_iter().next() {
            return Ok((row, index.filter(|_| sure)));
        }
        let (kind, name) = misfit.unwrap_or_default();
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
