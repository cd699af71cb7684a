//! The frames of one variant in a stream, as columns.

use super::cells::{Cells, Numbers};
use crate::message::VariantId;
use crate::table::Table;

/// All frames of one variant, in the order of the stream.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// The variant.
    pub variant: VariantId,
    /// Where each frame starts.
    pub offsets: Vec<u64>,
    /// The address byte of each frame; empty if the format has no addresses.
    pub addresses: Vec<u8>,
    /// A column for each field. A field with an array of numbers has several cells for each frame.
    pub fields: Vec<Cells>,
}

impl Rows {
    pub(crate) fn new(table: &Table, variant: VariantId, numbers: Numbers) -> Self {
        let fields = table
            .variant(variant)
            .map_or(&[][..], |variant| variant.fields());
        Self {
            variant,
            offsets: Vec::new(),
            addresses: Vec::new(),
            fields: fields
                .iter()
                .map(|field| Cells::new(field, numbers))
                .collect(),
        }
    }

    /// Reuse the memory of `old`, if its columns have the same types.
    pub(crate) fn reuse(&mut self, old: Self) {
        let alike = |(new, old): (&Cells, &Cells)| {
            std::mem::discriminant(new) == std::mem::discriminant(old)
        };
        let columns = self.fields.len() == old.fields.len();
        if columns && self.fields.iter().zip(&old.fields).all(alike) {
            *self = old;
            self.clear();
        }
    }

    /// Remove all rows, but keep their memory.
    pub(crate) fn clear(&mut self) {
        self.offsets.clear();
        self.addresses.clear();
        self.fields.iter_mut().for_each(Cells::clear);
    }

    /// Append the rows of `other`, and leave it empty, with its memory.
    pub(crate) fn append(&mut self, other: &mut Self) {
        if other.offsets.is_empty() {
            return;
        }
        self.offsets.append(&mut other.offsets);
        self.addresses.append(&mut other.addresses);
        for (all, more) in self.fields.iter_mut().zip(&mut other.fields) {
            all.append(more);
        }
    }

    /// Return no rows, with columns of the same types.
    pub(crate) fn like(&self) -> Self {
        Self {
            variant: self.variant,
            offsets: Vec::new(),
            addresses: Vec::new(),
            fields: self.fields.iter().map(Cells::like).collect(),
        }
    }

    /// Return the contents, and leave empty columns of the same types.
    pub(crate) fn take(&mut self) -> Self {
        let empty = self.like();
        std::mem::replace(self, empty)
    }
}
