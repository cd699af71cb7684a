//! Values to encode, as a caller passes them.

use std::convert::Infallible;

use cobotwire_core::{Encoding, Given, Row, Unread, ValueFault};

/// A value as a caller passes it.
#[derive(Clone, Debug, PartialEq)]
pub enum Sample {
    Integer(i64),
    Real(f64),
    Row(Vec<Sample>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Samples(pub Vec<Sample>);

impl Given for Sample {
    type Error = Infallible;
    type Row = Samples;

    fn integer(&self, _: bool) -> Result<i64, Unread<Infallible>> {
        match self {
            Self::Integer(integer) => Ok(*integer),
            _ => Err(Unread::Fault(ValueFault::Type)),
        }
    }

    fn real(&self) -> Result<f64, Unread<Infallible>> {
        match self {
            Self::Integer(integer) => Ok(*integer as f64),
            Self::Real(real) => Ok(*real),
            _ => Err(Unread::Fault(ValueFault::Type)),
        }
    }

    fn row(&self) -> Result<Samples, Unread<Infallible>> {
        match self {
            Self::Row(all) => Ok(Samples(all.clone())),
            _ => Err(Unread::Fault(ValueFault::Type)),
        }
    }

    fn counted(&self) -> bool {
        false
    }

    fn bytes(&self) -> Result<Option<Vec<u8>>, Unread<Infallible>> {
        Ok(None)
    }

    fn text(&self, _: Encoding) -> Result<Vec<u8>, Unread<Infallible>> {
        Err(Unread::Fault(ValueFault::Type))
    }
}

impl Row for Samples {
    type Item = Sample;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn at(&self, index: usize) -> Option<Sample> {
        self.0.get(index).cloned()
    }

    fn into_value(self) -> Sample {
        Sample::Row(self.0)
    }
}
