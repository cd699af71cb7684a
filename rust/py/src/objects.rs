//! The Python objects of a table's commands, for messages and errors.

use std::collections::HashMap;

use cobotwire_core::Direction;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::words::word;

/// The objects of all commands, by index.
pub struct Commands {
    all: Vec<Command>,
    by_name: HashMap<String, usize>,
}

/// The objects of one command: itself and its variants.
pub struct Command {
    pub object: Py<PyAny>,
    request: Vec<Py<PyAny>>,
    reply: Vec<Py<PyAny>>,
}

impl Commands {
    /// Return the objects of a table; `names` are those of its commands.
    pub fn new(table: &Bound<'_, PyAny>, names: Vec<String>) -> PyResult<Self> {
        let mut by_name = HashMap::new();
        for (index, name) in names.into_iter().enumerate() {
            by_name.entry(name).or_insert(index);
        }
        let commands = table.getattr("commands")?.try_iter()?;
        let all = commands
            .map(|command| Command::new(command?))
            .collect::<PyResult<_>>()?;
        Ok(Self { all, by_name })
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

    /// The index of the command with that name, if there is one.
    pub fn known(&self, name: &Bound<'_, PyAny>) -> Option<usize> {
        word(name).and_then(|name| self.by_name.get(name)).copied()
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
