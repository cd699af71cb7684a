//! Requests by the names of their arguments.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Display;

use crate::texts::error_text;
use crate::{Edition, Field};

/// A value that the table gives a request.
#[derive(Clone, Debug, PartialEq)]
pub enum Filled {
    /// The number of elements of a list, which the encoder counts.
    Counted,
    /// A constant without a scale.
    Integer(i64),
    /// A constant or a default.
    Real(f64),
    /// The default of a row.
    Row(Vec<f64>),
}

impl Edition {
    /// Return the values of the variant of a request that takes exactly the given arguments, in the
    /// order of the wire; and its index, unless several do, so that the values must decide.
    ///
    /// # Errors
    /// No variant does; the text names an argument at fault.
    pub fn arrange<V: Clone>(
        &self,
        command: usize,
        given: &[(&str, V)],
        filled: impl Fn(Filled) -> V,
    ) -> Result<(Vec<V>, Option<usize>), String> {
        let Some(record) = self.commands.get(command) else {
            return Ok((Vec::new(), None));
        };
        let (mut fitting, mut misfit) = (Vec::new(), None);
        for (index, variant) in record.request.iter().enumerate() {
            match self.row((command, index), variant, given, &filled) {
                Ok(row) => fitting.push((index, row)),
                Err((kind, name)) => {
                    misfit.get_or_insert((kind, name));
                }
            }
        }
        let sure = fitting.len() == 1;
        if let Some((index, row)) = fitting.into_iter().next() {
            return Ok((row, sure.then_some(index)));
        }
        let (kind, name) = misfit.unwrap_or_default();
        let fields = record.request.first().into_iter().flatten();
        let fields = fields.filter(|field| field.constant.is_none() && field.counts.is_none());
        let allowed = fields
            .map(|field| &*field.name)
            .collect::<Vec<_>>()
            .join(", ");
        let allowed = match &*allowed {
            "" => error_text("no-arguments", &[]),
            _ => allowed,
        };
        let places: [(&str, &dyn Display); 3] = [
            ("call", &record.name),
            ("name", &name),
            ("allowed", &allowed),
        ];
        Err(error_text(kind, &places))
    }

    fn row<V: Clone>(
        &self,
        (command, variant): (usize, usize),
        fields: &[Field],
        given: &[(&str, V)],
        filled: &impl Fn(Filled) -> V,
    ) -> Result<Vec<V>, (&'static str, String)> {
        for (name, _) in given {
            if !fields.iter().any(|field| field.name == *name) {
                return Err(("odd-argument", String::from(*name)));
            }
        }
        let commands = self.protocol.table.commands();
        let variant = commands
            .get(command)
            .and_then(|each| each.request.get(variant));
        let mut row = Vec::with_capacity(fields.len());
        for (index, field) in fields.iter().enumerate() {
            let number = || variant?.fields().get(index)?.cases.first()?.numbers.first();
            let given = given.iter().find(|(name, _)| field.name == *name);
            row.push(
                match (given, &field.counts, field.constant, &field.default) {
                    (_, Some(_), ..) => filled(Filled::Counted),
                    (_, _, Some(raw), _) => filled(match number() {
                        Some(number) if number.scaled() => {
                            Filled::Real(raw as f64 * number.multiply as f64 / number.divide as f64)
                        }
                        _ => Filled::Integer(raw),
                    }),
                    (Some((_, value)), ..) => value.clone(),
                    (.., Some(default)) => filled(match &**default {
                        [one] => Filled::Real(*one),
                        several => Filled::Row(several.to_vec()),
                    }),
                    _ => return Err(("missing-argument", field.name.clone())),
                },
            );
        }
        Ok(row)
    }
}
