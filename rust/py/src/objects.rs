//! The Python objects of a table's commands, for messages and errors.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use cobotwire_core::Direction;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::words::word;

/// The objects of all commands, by index.
pub struct Commands {
    all: Vec<Command>,
    by_name: HashMap<String, usize>,
    /// The same, by the address of the interned name: string literals in programs are interned.
    by_address: HashMap<usize, usize, BuildHasherDefault<AddressHasher>>,
    /// Keeps the interned names alive, so that no other object gets one of their addresses.
    _names: Vec<Py<PyString>>,
}

/// Hashes an address by multiplying it by an odd constant with irregular bits.
#[derive(Default)]
struct AddressHasher(u64);

impl Hasher for AddressHasher {
    fn finish(&self) -> u64 {
        self.0.rotate_left(32) // the high bits depend on the whole address
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_usize(usize::from(*byte));
        }
    }

    fn write_usize(&mut self, number: usize) {
        self.0 = (self.0 ^ number as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
}

/// The objects of one command: itself and its variants.
pub struct Command {
    pub object: Py<PyAny>,
    request: Vec<Py<PyAny>>,
    reply: Vec<Py<PyAny>>,
}

impl Commands {
    /// Return the objects of a table; `names` are the names of its commands.
    pub fn new(table: &Bound<'_, PyAny>, names: Vec<String>) -> PyResult<Self> {
        let (mut by_name, mut by_address) = (HashMap::new(), HashMap::default());
        let mut interned = Vec::with_capacity(names.len());
        for (index, name) in names.into_iter().enumerate() {
            let string = PyString::intern(table.py(), &name);
            by_address.entry(string.as_ptr() as usize).or_insert(index);
            interned.push(string.unbind());
            by_name.entry(name).or_insert(index);
        }
        let commands = table.getattr("commands")?.try_iter()?;
        let all = commands
            .map(|command| Command::new(command?))
            .collect::<PyResult<_>>()?;
        Ok(Self {
            all,
            by_name,
            by_address,
            _names: interned,
        })
    }

    /// Return the index of the command with that name. For an unknown name, the table raises the
    /// error, which suggests the nearest name.
    pub fn find(&self, table: &Py<PyAny>, name: &Bound<'_, PyAny>) -> PyResult<usize> {
        if let Some(index) = self.known(name) {
            return Ok(index);
        }
        let found = table.bind(name.py()).call_method1("command", (name,))?;
        let place = self
            .all
            .iter()
            .position(|command| command.object.is(&found));
        place.ok_or_else(|| PyKeyError::new_err((name.clone().unbind(),)))
    }

    /// Return the index of the command with that name; `None` if the table has no such command.
    pub fn known(&self, name: &Bound<'_, PyAny>) -> Option<usize> {
        let known = self.by_address.get(&(name.as_ptr() as usize));
        let known = known.or_else(|| self.by_name.get(word(name)?));
        known.copied()
    }

    pub fn get(&self, index: usize) -> PyResult<&Command> {
        self.all
            .get(index)
            .ok_or_else(|| PyKeyError::new_err(index))
    }
}

impl Command {
    fn new(object: Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self {
            request: object.getattr("request")?.extract()?,
            reply: object.getattr("reply")?.extract()?,
            object: object.unbind(),
        })
    }

    /// Return the variants in one direction.
    pub fn variants(&self, direction: Direction) -> &[Py<PyAny>] {
        match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        }
    }

    /// Return one variant.
    pub fn variant<'py>(
        &self,
        py: Python<'py>,
        direction: Direction,
        index: usize,
    ) -> PyResult<&Bound<'py, PyAny>> {
        let variant = self.variants(direction).get(index);
        let variant = variant.ok_or_else(|| PyKeyError::new_err(index))?;
        Ok(variant.bind(py))
    }
}
