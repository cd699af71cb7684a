//! Computes CRCs from their parameters, as in Greg Cook's catalogue (the Rocksoft model).

use alloc::boxed::Box;

/// The parameters of a CRC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrcParameters {
    /// Its width in bits: 1 to 120.
    pub width: u32,
    /// The polynomial, without its highest bit.
    pub poly: u128,
    /// The register at the start.
    pub init: u128,
    /// Whether the lowest bit of each byte comes first.
    pub refin: bool,
    /// Whether the result is reversed.
    pub refout: bool,
    /// The result is combined with this number by XOR.
    pub xorout: u128,
}

/// A CRC with a table of the effect of each byte, which is eight times as fast as a loop over bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crc {
    parameters: CrcParameters,
    steps: Box<[u128; 256]>,
}

impl Crc {
    /// Return the CRC with these parameters; `None` if its width is not 1 to 120 bits.
    #[must_use]
    pub fn new(parameters: CrcParameters) -> Option<Self> {
        if !(1..=120).contains(&parameters.width) {
            return None;
        }
        let mut steps = Box::new([0; 256]);
        for (byte, step) in (0..256).zip(steps.iter_mut()) {
            *step = if parameters.refin {
                step_low(byte, &parameters)
            } else {
                step_high(byte, &parameters)
            };
        }
        Some(Self { parameters, steps })
    }

    /// Return its parameters.
    #[must_use]
    pub fn parameters(&self) -> &CrcParameters {
        &self.parameters
    }

    /// Return the number of bytes that hold it.
    #[must_use]
    pub fn size(&self) -> usize {
        self.parameters.width.div_ceil(8) as usize
    }

    /// Return the CRC of some bytes.
    #[must_use]
    pub fn of(&self, data: &[u8]) -> u128 {
        let CrcParameters {
            width,
            init,
            refin,
            refout,
            xorout,
            ..
        } = self.parameters;
        let mut crc = if refin {
            data.iter().fold(reverse(init, width), |crc, byte| {
                crc >> 8 ^ self.step(crc ^ u128::from(*byte))
            })
        } else {
            // The register stands at the top of the number.
            let low = 128 - width;
            data.iter().fold(init << low, |crc, byte| {
                crc << 8 ^ self.step(crc >> 120 ^ u128::from(*byte))
            }) >> low
        };
        if refin != refout {
            crc = reverse(crc, width);
        }
        crc ^ xorout
    }

    #[inline]
    fn step(&self, index: u128) -> u128 {
        let [low, ..] = index.to_le_bytes();
        let step = self.steps.get(usize::from(low));
        step.copied().unwrap_or_default()
    }
}

fn step_low(byte: u128, parameters: &CrcParameters) -> u128 {
    let poly = reverse(parameters.poly, parameters.width);
    (0..8).fold(byte, |crc, _| {
        if crc & 1 == 1 {
            crc >> 1 ^ poly
        } else {
            crc >> 1
        }
    })
}

fn step_high(byte: u128, parameters: &CrcParameters) -> u128 {
    let poly = parameters.poly << (128 - parameters.width);
    (0..8).fold(byte << 120, |crc, _| {
        if crc >> 127 == 1 {
            crc << 1 ^ poly
        } else {
            crc << 1
        }
    })
}

fn reverse(value: u128, width: u32) -> u128 {
    value.reverse_bits() >> (128 - width)
}
