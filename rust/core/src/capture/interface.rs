//! An interface of a recording, and how to read the times of its packets.

use super::body::Body;
use super::damage::Fault;

const NAME: u16 = 2;
const DESCRIPTION: u16 = 3;
const SPEED: u16 = 8;
const RESOLUTION: u16 = 9;
const OFFSET: u16 = 14;

const MICROSECONDS: u8 = 6;
const SECOND: u128 = 1_000_000_000;

/// An interface that a file describes. Its texts are the bytes of the file, not checked to be
/// UTF-8.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    /// Its name: a port or URL.
    pub name: Vec<u8>,
    /// Its description, which may name an edition.
    pub description: Vec<u8>,
    /// Bits a second; 0 if unknown.
    pub speed: u64,
}

/// How to read the packets of an interface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Format {
    pub(crate) link_type: u16,
    resolution: u8,
    /// Added to each time, in nanoseconds.
    offset: i128,
}

impl Format {
    /// Read the description of an interface.
    pub(crate) fn read(body: &mut Body<'_>) -> Result<(Self, Interface), Fault> {
        let link_type = body.half()?;
        body.half()?;
        body.word()?;
        let none = &[][..];
        let (mut name, mut description) = (none, none);
        let (mut speed, mut resolution, mut offset) = (none, none, none);
        while let Some((code, value)) = body.option()? {
            match code {
                NAME => name = value,
                DESCRIPTION => description = value,
                SPEED => speed = value,
                RESOLUTION => resolution = value,
                OFFSET => offset = value,
                _ => {}
            }
        }
        let interface = Interface {
            name: name.to_vec(),
            description: description.to_vec(),
            speed: body.order().number(speed)?,
        };
        let format = Self {
            link_type,
            resolution: resolution.first().copied().unwrap_or(MICROSECONDS),
            offset: i128::from(body.order().signed(offset)?) * SECOND as i128,
        };
        Ok((format, interface))
    }

    /// Return a time stamp in nanoseconds since 1970; fractions of a nanosecond are cut off.
    #[inline]
    pub(crate) fn nanoseconds(&self, high: u32, low: u32) -> Result<i64, Fault> {
        let stamp = u64::from(high) << 32 | u64::from(low);
        let since = if self.resolution == 9 {
            u128::from(stamp)
        } else {
            self.scaled(stamp)
        };
        // At most 2^64 seconds in nanoseconds, so neither number is near 128 bits.
        i64::try_from(since as i128 + self.offset).map_err(|_| Fault::TimeRange)
    }

    #[cold]
    fn scaled(&self, stamp: u64) -> u128 {
        let all = u128::from(stamp) * SECOND;
        let exponent = u32::from(self.resolution & 0x7F);
        if self.resolution & 0x80 != 0 {
            return all >> exponent;
        }
        // A divisor of more than 128 bits is larger than any dividend, so the quotient is 0.
        10_u128.checked_pow(exponent).map_or(0, |units| all / units)
    }
}
