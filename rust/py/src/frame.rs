//! `NativeFrame`: a frame that owns its bytes and is decoded on first use.

use std::sync::Arc;

use cobotwire_core::{DecodeError, Direction, Frame, Listening, OwnedFrame, Rules, VariantId};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::edition::Edition;
use crate::names::Names;
use crate::once::Once;
use crate::values::{objects, plain_objects};
use crate::words::one_way;

/// The data that all frames of one framer share. Python counts its references, since that is faster
/// than counting them for several threads at once.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct Origin {
    pub edition: Arc<Edition>,
    pub rules: Rules,
    /// The first direction that the framer listens to.
    pub direction: Direction,
}

/// A whole, legal frame; `frame_class` has its Python class.
pub struct NativeFrame {
    origin: Py<Origin>,
    /// The position of its first byte in the stream.
    pub offset: u64,
    frame: OwnedFrame,
    /// Its values, if they were used more than once, or take long to decode.
    values: Once,
}

/// What a frame says.
struct Message<'py> {
    variant: VariantId,
    values: Bound<'py, PyTuple>,
    address: Option<u8>,
}

impl NativeFrame {
    #[inline]
    pub fn new(origin: Py<Origin>, offset: u64, frame: Frame<'_>) -> Self {
        Self {
            origin,
            offset,
            frame: frame.into(),
            values: Once::new(),
        }
    }

    fn frame(&self) -> Frame<'_> {
        self.frame.get(self.origin.get().edition.core.frame())
    }

    /// Decode it in one direction, or in those that the framer listens to. With `of`, only messages
    /// of the command with that index count.
    fn read<'py>(
        &self,
        py: Python<'py>,
        direction: Option<Direction>,
        of: Option<usize>,
    ) -> PyResult<Message<'py>> {
        let Origin { edition, rules, .. } = self.origin.get();
        let rules = direction.map_or(rules, |way| edition.core.rules(Listening::To(way)));
        self.decoded(py, rules, of)?.map_err(|error| {
            let direction = direction.unwrap_or(self.origin.get().direction);
            match Names::get(py) {
                Ok(names) => {
                    let direction = names.direction(py, direction);
                    edition.rejected(py, error, direction, self.frame.bytes())
                }
                Err(error) => error,
            }
        })
    }

    fn decoded<'py>(
        &self,
        py: Python<'py>,
        rules: &Rules,
        of: Option<usize>,
    ) -> PyResult<Result<Message<'py>, DecodeError>> {
        let (core, frame) = (&self.origin.get().edition.core, self.frame());
        if let Some(plain) = cobotwire_core::read_plain(core, rules, frame, of)
            && let Some(values) = plain_objects(py, plain.numbers)?
        {
            return Ok(Ok(Message {
                variant: plain.variant,
                values,
                address: plain.address,
            }));
        }
        let decoded = match cobotwire_core::read(core, rules, frame, of) {
            Ok(decoded) => decoded,
            Err(error) => return Ok(Err(error)),
        };
        Ok(Ok(Message {
            variant: decoded.variant,
            values: objects(py, &decoded.values)?,
            address: decoded.address,
        }))
    }

    /// Return the message, as Python's named tuple.
    fn tuple_of<'py>(&self, message: &Message<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Message {
            variant,
            values,
            address,
        } = message;
        let edition = &self.origin.get().edition;
        edition.message(values.py(), *variant, values, *address)
    }
}

/// What Python's class has.
impl NativeFrame {
    /// Its bytes, from header to check.
    pub fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.frame.bytes())
    }

    /// Its command id.
    pub fn command(&self) -> u16 {
        self.frame().id()
    }

    /// Its message: the first one that allows its values.
    pub fn message<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let read = self.read(py, None, None)?;
        let values = self.values.set(read.values);
        self.tuple_of(&Message { values, ..read })
    }

    /// Return what `codec.decode(direction, frame.data, of=of)` returns, without judging it again.
    pub fn decode<'py>(
        &self,
        py: Python<'py>,
        direction: Option<&Bound<'py, PyAny>>,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Edition {
            table, commands, ..
        } = &*self.origin.get().edition;
        let of = of.filter(|name| !name.is_none());
        let of = of.map(|name| commands.find(table, name)).transpose()?;
        let direction = direction.filter(|word| !word.is_none());
        self.tuple_of(&self.read(py, direction.map(one_way).transpose()?, of)?)
    }

    /// The values of its message, one for each field.
    #[inline]
    pub fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        if let Some(values) = self.values.get(py) {
            return Ok(values);
        }
        let Origin { edition, rules, .. } = self.origin.get();
        let plain = cobotwire_core::read_plain(&edition.core, rules, self.frame(), None);
        let plain = plain.map(|plain| plain_objects(py, plain.numbers));
        match plain.transpose()?.flatten() {
            // Most programs read a frame once: keeping its values then takes memory, and more time
            // than decoding them.
            Some(values) if self.values.is_first(py) => Ok(values),
            Some(values) => Ok(self.values.set(values)),
            None => Ok(self.values.set(self.read(py, None, None)?.values)),
        }
    }

    /// Whether two frames are equal.
    pub fn same(&self, other: &Self) -> bool {
        self.offset == other.offset && self.frame == other.frame
    }

    /// Return the hash of Python's own class of frames, because the two can be equal.
    pub fn hash(&self, py: Python<'_>) -> PyResult<isize> {
        (self.offset, self.command(), self.data(py))
            .into_pyobject(py)?
            .hash()
    }

    pub fn repr(&self) -> String {
        let bytes = self.frame.bytes().iter();
        let data: Vec<String> = bytes.map(|byte| format!("{byte:02X}")).collect();
        format!("<Frame {} at {}>", data.join(" "), self.offset)
    }

    /// Drop it in a thread that is attached, which saves asking whether it is.
    pub fn drop_in(self, py: Python<'_>) {
        self.origin.drop_ref(py);
    }
}
