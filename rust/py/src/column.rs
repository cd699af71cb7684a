//! `Column`: the numbers of a `Memory`.

use std::ffi::{CStr, c_void};

use cobotwire_core::Cells;

/// The contents of a column: offsets, or the numbers of a field.
pub enum Column {
    Offsets(Vec<u64>),
    Cells(Cells),
}

impl Column {
    /// Return the numbers of a field.
    pub fn into_cells(self) -> Cells {
        match self {
            Self::Cells(cells) => cells,
            Self::Offsets(_) => Cells::F64(Vec::new()),
        }
    }

    /// Return whether it has no numbers.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Offsets(all) => all.is_empty(),
            Self::Cells(cells) => cells.is_empty(),
        }
    }

    /// Return its address, the number of its elements, their size, and their type for `struct`.
    pub fn parts(&mut self) -> (*mut c_void, usize, usize, &'static CStr) {
        fn of<T>(
            all: &mut Vec<T>,
            format: &'static CStr,
        ) -> (*mut c_void, usize, usize, &'static CStr) {
            (all.as_mut_ptr().cast(), all.len(), size_of::<T>(), format)
        }
        match self {
            Self::Offsets(all) => of(all, c"Q"),
            Self::Cells(Cells::F64(all)) => of(all, c"d"),
            Self::Cells(Cells::U8(all)) => of(all, c"B"),
            Self::Cells(Cells::I8(all)) => of(all, c"b"),
            Self::Cells(Cells::U16(all)) => of(all, c"H"),
            Self::Cells(Cells::I16(all)) => of(all, c"h"),
            Self::Cells(Cells::U32(all)) => of(all, c"I"),
            Self::Cells(Cells::I32(all)) => of(all, c"i"),
            Self::Cells(Cells::I64(all)) => of(all, c"q"),
        }
    }
}
